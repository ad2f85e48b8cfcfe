/** The service worker: keeps the pages, the models and the site's facts, and answers with them where there is no network. Thin. */

import { answerFor, FACTS, type Kept, modelsIn } from "./keeping";

/** Put in by the build: its files, and their common version. */
declare const KEPT_FILES: readonly Kept[];
declare const KEPT_VERSION: string;

/** What of a service worker is used here; the library of types for workers excludes that for pages. */
interface Life extends Event {
  waitUntil(done: Promise<unknown>): void;
}
interface Asked extends Life {
  readonly request: Request;
  respondWith(answer: Promise<Response>): void;
}
interface Told extends Life {
  readonly data: unknown;
  readonly source: { postMessage(message: unknown): void } | null;
}
interface Worker {
  readonly clients: { claim(): Promise<void> };
  addEventListener(name: "install" | "activate", listener: (event: Life) => void): void;
  addEventListener(name: "fetch", listener: (event: Asked) => void): void;
  addEventListener(name: "message", listener: (event: Told) => void): void;
}
const worker = globalThis as unknown as Worker;

const BUILD = `agora-build-${KEPT_VERSION}`;
const SITE = "agora-site";
/** A network that has not answered for so long is taken for none. */
const PATIENCE_MS = 4000;

worker.addEventListener("install", (event) => event.waitUntil(keepBuild()));
worker.addEventListener("activate", (event) => event.waitUntil(begin()));
worker.addEventListener("message", (event) => {
  if (event.data !== "keep") return;
  event.waitUntil(keepSite().then((isKept) => event.source?.postMessage({ isKept })));
});
worker.addEventListener("fetch", (event) => {
  const answer = answerFor(event.request, location.origin, KEPT_FILES);
  if (answer.kind === "page") event.respondWith(page(event.request, answer.file));
  else if (answer.kind === "kept") event.respondWith(keptOrFetched(event.request));
  else if (answer.kind === "facts") event.respondWith(facts(event.request));
});

/** Keep the whole build, or nothing of it: a file that is of another build does not have its hash. */
async function keepBuild(): Promise<void> {
  const cache = await caches.open(BUILD);
  await cache.addAll(KEPT_FILES.map(({ url, integrity }) => new Request(url, { integrity, cache: "no-cache" })));
}

async function begin(): Promise<void> {
  const names = await caches.keys();
  const old = names.filter((name) => name.startsWith("agora-build-") && name !== BUILD);
  await Promise.all(old.map((name) => caches.delete(name)));
  await worker.clients.claim();
}

/** Keep the site as it is now, models first; returns whether a whole one is kept. */
async function keepSite(): Promise<boolean> {
  const cache = await caches.open(SITE);
  try {
    const answer = await fetch(FACTS, { cache: "no-cache" });
    if (!answer.ok) throw new Error(`${FACTS}: ${answer.status}`);
    const models = modelsIn(await answer.clone().json());
    for (const url of models) if (!(await cache.match(url))) await cache.add(url);
    await cache.put(FACTS, answer);
    for (const { url } of await cache.keys()) {
      const { pathname, search } = new URL(url);
      if (pathname !== FACTS && !models.includes(pathname + search)) await cache.delete(url);
    }
  } catch (error) {
    console.warn("the site could not be kept anew", error);
  }
  return (await cache.match(FACTS)) !== undefined;
}

/** The server's page where it answers, else the kept one. */
async function page(request: Request, file: string): Promise<Response> {
  return (await fromNetwork(request)) ?? (await keptFile(file)) ?? Response.error();
}

async function facts(request: Request): Promise<Response> {
  const answer = await fromNetwork(request);
  if (answer !== null) return answer;
  const kept = await (await caches.open(SITE)).match(FACTS);
  // without its date: a page would set its clock by it
  return kept ? new Response(kept.body, { headers: { "Content-Type": "application/json" } }) : Response.error();
}

/** Return what the network answers, or null where it does not, or a proxy says that nobody is there. */
async function fromNetwork(request: Request): Promise<Response | null> {
  try {
    const answer = await fetch(request, { signal: AbortSignal.timeout(PATIENCE_MS) });
    return answer.status >= 502 && answer.status <= 504 ? null : answer;
  } catch {
    return null;
  }
}

async function keptOrFetched(request: Request): Promise<Response> {
  const { pathname, search } = new URL(request.url);
  return (await keptFile(pathname + search)) ?? (await (await caches.open(SITE)).match(request.url)) ?? fetch(request);
}

async function keptFile(url: string): Promise<Response | undefined> {
  return (await caches.open(BUILD)).match(url);
}
