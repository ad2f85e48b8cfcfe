/** Asks the service worker to keep the pages and the site on this device, once the page itself has all that it needs. DOM only. */

/** Before a page that never has all that it needs is kept all the same. */
const PATIENCE_MS = 15_000;

/** Keep everything for a visit without network, after `ready`; returns whether it is. */
export async function keepForLater(ready: () => Promise<unknown>): Promise<boolean> {
  if (!import.meta.env.PROD || location.protocol === "file:" || !("serviceWorker" in navigator)) return false;
  await Promise.race([ready(), new Promise((resolve) => window.setTimeout(resolve, PATIENCE_MS))]);
  await navigator.serviceWorker.register("/worker.js");
  const { active } = await navigator.serviceWorker.ready;
  return new Promise((resolve) => {
    navigator.serviceWorker.addEventListener("message", ({ data }: MessageEvent<{ isKept?: unknown }>) =>
      resolve(data.isKept === true),
    );
    active?.postMessage("keep");
  });
}
