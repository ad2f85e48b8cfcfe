/**
 * What is kept on a device so that the pages work without a network, and which request is answered from where. Pure.
 *
 * Nothing can be mixed up: the pages' files are of one build, each checked against its hash; a model's address names its
 * content (`?v=`); and a site's facts are kept only once all the models that they name are.
 */

/** A file of the build: its address, and its hash as `fetch` checks it. */
export interface Kept {
  readonly url: string;
  readonly integrity: string;
}

/** How a request is answered: a page, by this file; from what is kept, else the network; the site's facts; or not by us. */
export type Answer =
  | { readonly kind: "page"; readonly file: string }
  | { readonly kind: "kept" }
  | { readonly kind: "facts" }
  | { readonly kind: "network" };

export const FACTS = "/api/site";
const PAGES: readonly (readonly [RegExp, string])[] = [
  [/^\/$/, "/index.html"],
  [/^\/ar\/?$/, "/ar.html"],
  [/^\/replay\/[^/]+\/?$/, "/replay.html"],
];
const NETWORK: Answer = { kind: "network" };

/** Return how a request is to be answered; `files` are the build's. */
export function answerFor(
  request: { readonly method: string; readonly mode: string; readonly url: string },
  origin: string,
  files: readonly Kept[],
): Answer {
  const url = new URL(request.url);
  if (request.method !== "GET" || url.origin !== origin) return NETWORK;
  if (request.mode === "navigate") {
    const file = PAGES.find(([address]) => address.test(url.pathname))?.[1];
    return file !== undefined && files.some((kept) => kept.url === file) ? { kind: "page", file } : NETWORK;
  }
  if (url.pathname === FACTS) return { kind: "facts" };
  if (isModel(url)) return { kind: "kept" };
  return files.some((kept) => kept.url === url.pathname) ? { kind: "kept" } : NETWORK;
}

/** Return the addresses of all models that a site's facts name, each once. */
export function modelsIn(facts: unknown): readonly string[] {
  if (typeof facts === "string")
    return isModel(new URL(facts, "https://site.invalid")) && facts[0] === "/" ? [facts] : [];
  if (typeof facts !== "object" || facts === null) return [];
  return [...new Set(Object.values(facts).flatMap(modelsIn))];
}

/** Whether an address names a model by its content, so that it never changes. */
function isModel(url: URL): boolean {
  return url.pathname.startsWith("/models/") && url.searchParams.has("v");
}
