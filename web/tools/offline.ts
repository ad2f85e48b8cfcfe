/** Tells the service worker, after a build, which files it is to keep, each by its hash. */

import { createHash } from "node:crypto";
import { readdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { join, relative } from "node:path";
import type { Plugin } from "vite";

const WORKER = "worker.js";

function filesBelow(folder: string): string[] {
  return readdirSync(folder)
    .map((name) => join(folder, name))
    .flatMap((path) => (statSync(path).isDirectory() ? filesBelow(path) : [path]));
}

/** Put the build's files and their version into its service worker; `notKept` are addresses that nobody needs without a network. */
export function offline(notKept: readonly string[] = []): Plugin {
  let folder = "";
  return {
    name: "agora-offline",
    apply: "build",
    configResolved(config) {
      folder = config.build.outDir;
    },
    closeBundle() {
      const files = filesBelow(folder)
        .filter((path) => !relative(folder, path).startsWith("."))
        .map((path) => ({ path, url: `/${relative(folder, path).replaceAll("\\", "/")}` }))
        .filter(({ url }) => url !== `/${WORKER}` && !notKept.includes(url))
        .sort((a, b) => (a.url < b.url ? -1 : 1))
        .map(({ path, url }) => ({ url, integrity: `sha256-${hash(readFileSync(path), "base64")}` }));
      const list = JSON.stringify(files);
      const worker = readFileSync(join(folder, WORKER), "utf8");
      // a classic worker, which every browser knows, has no modules
      if (/^\s*(import|export)\b/m.test(worker)) throw new Error(`${WORKER} shares code with a page`);
      const told = `const KEPT_FILES=${list};const KEPT_VERSION="${hash(list, "hex").slice(0, 12)}";\n${worker}`;
      writeFileSync(join(folder, WORKER), told);
    },
  };
}

function hash(data: string | Buffer, coding: "base64" | "hex"): string {
  return createHash("sha256").update(data).digest(coding);
}
