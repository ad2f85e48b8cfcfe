/** What is kept for a visit without network, and what a request is answered with. */

import { answerFor, modelsIn } from "../../web/src/offline/keeping";

const ORIGIN = "https://rig.example";
const FILES = ["/index.html", "/ar.html", "/replay.html", "/assets/a-1.js", "/icon.svg"].map((url) => ({
  url,
  integrity: "sha256-x",
}));

function answer(path: string, mode = "cors", method = "GET"): unknown {
  return answerFor({ method, mode, url: new URL(path, ORIGIN).href }, ORIGIN, FILES);
}

test.each([
  ["/", "/index.html"],
  ["/?lang=tr#walk", "/index.html"],
  ["/ar", "/ar.html"],
  ["/ar?session=a", "/ar.html"],
  ["/replay/some%20walk", "/replay.html"],
] as const)("the page %s is %s", (path, file) => {
  expect(answer(path, "navigate")).toEqual({ kind: "page", file });
});

test.each(["/console", "/enter", "/replay/", "/api/logs/walk"])("the page %s is the server's alone", (path) => {
  expect(answer(path, "navigate")).toEqual({ kind: "network" });
});

test("a page of which the build has no file is the server's alone", () => {
  expect(answerFor({ method: "GET", mode: "navigate", url: `${ORIGIN}/ar` }, ORIGIN, FILES.slice(0, 1))).toEqual({
    kind: "network",
  });
});

test.each([
  ["/assets/a-1.js", "kept"],
  ["/icon.svg", "kept"],
  ["/models/roman.0.glb?v=1", "kept"],
  ["/models/roman.0.glb", "network"],
  ["/assets/b-2.js", "network"],
  ["/api/site", "facts"],
  ["/api/sessions", "network"],
  ["https://elsewhere.example/assets/a-1.js", "network"],
] as const)("%s comes from %s", (path, kind) => {
  expect(answer(path)).toEqual({ kind });
});

test("what changes something is never answered from what is kept", () => {
  expect(answer("/api/site", "cors", "POST")).toEqual({ kind: "network" });
});

test("the models of a site are found wherever its facts name them, each once", () => {
  const facts = {
    models: {
      roman: { levels: ["/models/roman.0.glb?v=a", "/models/roman.1.glb?v=b"] },
      kiosk: "/models/kiosk.glb?v=c",
    },
    walkable: "/models/walkable.glb?v=d",
    again: ["/models/kiosk.glb?v=c"],
    occluders: null,
    eye_height_m: 1.65,
    name: "A text about /models/ of temples",
    unversioned: "/models/old.glb",
    foreign: "https://elsewhere.example/models/x.glb?v=e",
  };
  expect([...modelsIn(facts)].sort()).toEqual([
    "/models/kiosk.glb?v=c",
    "/models/roman.0.glb?v=a",
    "/models/roman.1.glb?v=b",
    "/models/walkable.glb?v=d",
  ]);
});
