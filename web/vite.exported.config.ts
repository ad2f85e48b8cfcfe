/** The script and the style of a walk that was saved as one file: each in one piece, to be put into that file. */

import { fileURLToPath } from "node:url";
import { defineConfig } from "vite";

export default defineConfig({
  publicDir: false,
  build: {
    target: "es2022",
    emptyOutDir: false, // the pages are there already
    chunkSizeWarningLimit: 1200,
    cssCodeSplit: false,
    lib: {
      entry: fileURLToPath(new URL("src/replay/exported.ts", import.meta.url)),
      formats: ["iife"],
      name: "agoraWalk",
      fileName: () => "exported.js",
      cssFileName: "exported",
    },
  },
});
