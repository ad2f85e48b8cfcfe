import { fileURLToPath } from "node:url";
import type { Plugin } from "vite";
import { defineConfig } from "vitest/config";
import { ahead } from "./tools/ahead.ts";
import { offline } from "./tools/offline.ts";

const here = (path: string): string => fileURLToPath(new URL(path, import.meta.url));

/** Serve `/ar` and `/replay/NAME` during development as the server does in use. */
function pages(): Plugin {
  return {
    name: "agora-pages",
    configureServer(server) {
      server.middlewares.use((request, _response, next) => {
        const name = /^\/(ar|replay)(\/[^/]+)?\/?(\?|$)/.exec(request.url ?? "")?.[1];
        if (name !== undefined) request.url = `/${name}.html`;
        next();
      });
    },
  };
}

const program = "127.0.0.1:8000"; // `agora demo`, when the pages are developed beside it

export default defineConfig({
  base: "/",
  plugins: [pages(), ahead(), offline()],
  build: {
    target: "es2022",
    chunkSizeWarningLimit: 900, // three.js is most of it
    rolldownOptions: {
      input: {
        index: here("index.html"),
        ar: here("ar.html"),
        replay: here("replay.html"),
        worker: here("src/offline/worker.ts"),
      },
      output: {
        // a service worker is known by its address
        entryFileNames: ({ name }) => (name === "worker" ? "worker.js" : "assets/[name]-[hash].js"),
      },
    },
  },
  server: {
    proxy: {
      "/api": `http://${program}`,
      "/models": `http://${program}`,
      "/ws": { target: `ws://${program}`, ws: true },
    },
  },
  test: {
    globals: true, // tests/web stands outside this folder, where no package can be imported by name
    dir: here("../tests/web"),
    environment: "node",
  },
});
