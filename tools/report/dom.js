// element("p", {class: "note"}, "text", child, ...)
function element(name, attributes, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

// Running text with no line break between a number and a short word after it, mostly its unit.
const unbroken = text => text.replaceAll(" = ", "\u00a0=\u00a0").replace(/(\d) (?=\S{1,5}(\s|$))/g, "$1\u00a0");

// A legend: [{swatch: Element, label, detail}].
function legend(items) {
  const list = element("ul", {class: "legend"});
  for (const {swatch, label, detail} of items) {
    const item = element("li", {}, swatch, element("span", {class: "label"}, label));
    if (detail) item.append(element("span", {class: "detail"}, detail));
    list.append(item);
  }
  return list;
}

// A small picture for a legend; `shapes` is SVG in a box of 30 by 14 and takes its colours from page.css.
function swatch(shapes) {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 30 14");
  svg.setAttribute("width", "30");
  svg.setAttribute("height", "14");
  svg.setAttribute("aria-hidden", "true");
  svg.innerHTML = shapes;
  return svg;
}

const lineSwatch = (name, {dash = "none", width = 2.5} = {}) => swatch(
  `<path d="M0 7H30" fill="none" stroke="var(--${name})" stroke-width="${width}" stroke-dasharray="${dash}"/>`);

// Shows a fault at the top of the page, which is then not marked as ready.
function showFault(text) {
  document.querySelector("main").prepend(element("p", {class: "fault", role: "alert"}, text));
}
