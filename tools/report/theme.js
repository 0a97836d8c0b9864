// Colours and fonts of the canvases. The custom properties of page.css are read at every drawing because they change
// with the system's colour scheme and in print.
const rootStyle = getComputedStyle(document.documentElement);

function color(name) {
  const value = rootStyle.getPropertyValue("--" + name).trim();
  if (value === "") throw new Error(`page.css has no colour --${name}`);
  return value;
}

// The name of the colour of drive number `i` of a section.
const driveColor = i => `drive-${i % 6}`;

// Each drive is drawn narrower than the previous one, so that those below remain visible where they coincide.
const driveWidth = (i, drives) => 1.6 * (drives.length - i);

// The colour of the sequential ramp at `share` (0 to 1).
function rampColor(share) {
  const at = share * 2;
  const from = Math.min(1, Math.floor(at));
  const channels = name => [1, 3, 5].map(i => parseInt(color(name).slice(i, i + 2), 16));
  const low = channels(`ramp-${from}`);
  const high = channels(`ramp-${from + 1}`);
  return `rgb(${low.map((c, i) => Math.round(c + (high[i] - c) * (at - from))).join(" ")})`;
}

const font = (size, weight = 400) => `${weight} ${size}px system-ui, sans-serif`;
