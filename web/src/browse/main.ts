/** The start page: the virtual square. */

import "../everyone";
import { canDraw, element, publishNothing, tell } from "../dom";
import { showFlat } from "../flat/flat";
import type { Matrix4, Vector3 } from "../frames";
import { languages, say } from "../language/speech";
import { parseSite, type Site } from "../site";
import { readAddress, type Shown } from "./address";
import type { Browse } from "./browse";
import { Directory } from "./directory";
import { firstOf } from "./first";
import { showWalks } from "./walks";

const directory = new Directory();
let browse: Browse | null = null;

/** Return the site, named on the page. */
async function loadSite(): Promise<Site> {
  const site = parseSite(await (await fetch("/api/site")).json(), languages(navigator.languages));
  element("site", HTMLElement).textContent = site.name;
  element("credit", HTMLElement).textContent = site.attribution;
  return site;
}

/** Begin to fetch what is drawn first, while what draws it is still on its way. */
function fetchAhead(site: Site, shown: Shown): Site {
  const first = site.models[firstOf(site, shown)]?.at(-1);
  if (first === undefined) return site;
  const link = document.createElement("link");
  Object.assign(link, { rel: "preload", as: "fetch", crossOrigin: "anonymous", href: first });
  document.head.append(link);
  return site;
}

/** Show the square as a plan, where it cannot be drawn. */
async function showPlan(): Promise<void> {
  showFlat(await loadSite(), document.querySelector(".everyone"));
}

async function show(): Promise<void> {
  try {
    // what draws is large: by itself, so that the page speaks the visitor's language before it has come
    const shown = readAddress(location.search, location.hash);
    const [site, drawing] = await Promise.all([
      loadSite().then((found) => fetchAhead(found, shown)),
      import("./browse"),
    ]);
    browse = new drawing.Browse(site, shown, directory);
    await browse.start(shown);
  } catch (error) {
    tell(element("notice", HTMLElement), say("trouble.model"));
    console.warn(error);
  }
}

/** Put `globalThis.agora` in place: what the page draws, for tests and support. */
function publish(ready: Promise<void>): void {
  const api = {
    ready,
    stats: (): unknown => browse?.stats ?? null,
    walkers: (): unknown => browse?.beside?.walkers ?? [],
    project: (place_site_m: Vector3): readonly [number, number] | null => browse?.stage.pointOf(place_site_m) ?? null,
    pose: (): {
      readonly t_ns: null;
      readonly frameId: null;
      readonly T_site_cam: Matrix4;
      readonly cov: null;
    } | null => browse && { t_ns: null, frameId: null, T_site_cam: browse.stage.explorer.T_site_cam, cov: null },
  };
  Object.defineProperty(globalThis, "agora", { value: Object.freeze(api) });
}

directory.listen(showWalks);
if (canDraw(element("notice", HTMLElement))) publish(show());
else publishNothing(showPlan());
