// Canvases are drawn with at least two pixels for each CSS pixel, also on a screen that has one: what is printed is
// the canvas as it stands. uPlot reads this when it is loaded, so it stands before it.
{
  const own = Object.getOwnPropertyDescriptor(window, "devicePixelRatio").get;
  Object.defineProperty(window, "devicePixelRatio", {get: () => Math.max(2, own.call(window))});
}
