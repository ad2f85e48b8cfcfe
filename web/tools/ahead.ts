/** Lets a page's browser fetch what its script will import later, at once: a script that is a part by itself is known only when another has run. */

import type { HtmlTagDescriptor, Plugin } from "vite";

/** Name in each page of a build the parts that its script imports when it runs, and what those import. */
export function ahead(): Plugin {
  return {
    name: "agora-ahead",
    apply: "build",
    transformIndexHtml(_html, { chunk, bundle }) {
      const wanted = new Set<string>();
      const want = (file: string): void => {
        const part = bundle?.[file];
        if (part?.type !== "chunk" || wanted.has(file)) return;
        wanted.add(file);
        part.imports.forEach(want);
      };
      chunk?.dynamicImports.forEach(want);
      return [...wanted]
        .filter((file) => file !== chunk?.fileName && !chunk?.imports.includes(file))
        .map(
          (file): HtmlTagDescriptor => ({
            tag: "link",
            injectTo: "head",
            attrs: { rel: "modulepreload", crossorigin: true, href: `/${file}` },
          }),
        );
    },
  };
}
