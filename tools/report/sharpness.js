// Canvases have at least two pixels per CSS pixel, even on a screen with one, because the canvas is printed as it is.
// uPlot reads the ratio when it is loaded, so this script precedes it.
{
  const own = Object.getOwnPropertyDescriptor(window, "devicePixelRatio").get;
  Object.defineProperty(window, "devicePixelRatio", {get: () => Math.max(2, own.call(window))});
}
