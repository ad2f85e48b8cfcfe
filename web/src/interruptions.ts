/** What takes the drawing away for a while, and how it comes back: the browser's graphics, and a page that is not looked at. DOM only. */

/** A browser that has not given the graphics back by then never will: the page is loaded anew. */
const RELOAD_AFTER_MS = 10_000;
/** Who looks away for longer is told that what is shown is new. */
const LONG_MS = 10_000;

export interface Listener {
  /** The graphics are gone, or there again. */
  drawing(lost: boolean): void;
  /** The page is looked at again, after so long. */
  back(longAway: boolean): void;
}

/** Listen for both. */
export function watchInterruptions(canvas: HTMLCanvasElement, listener: Listener): void {
  let timer: number | undefined;
  canvas.addEventListener("webglcontextlost", (event) => {
    event.preventDefault(); // else it is never given back
    listener.drawing(true);
    timer = window.setTimeout(() => location.reload(), RELOAD_AFTER_MS);
  });
  canvas.addEventListener("webglcontextrestored", () => {
    window.clearTimeout(timer);
    listener.drawing(false);
  });
  let hidden_ms = 0;
  document.addEventListener("visibilitychange", () => {
    if (document.visibilityState === "hidden") hidden_ms = performance.now();
    else listener.back(performance.now() - hidden_ms > LONG_MS);
  });
}
