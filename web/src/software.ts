/** Whether a drawing is made by the processor alone, and what that is slow at. */

import type { WebGLRenderer } from "three";

/** How many looks at a texture make one sharp where it is seen at a slant. */
const ANISOTROPY = 4;

/** Return whether there is no graphics card behind a renderer. */
export function drawsInSoftware(renderer: WebGLRenderer): boolean {
  return /swiftshader|llvmpipe|software|basic render/i.test(nameOf(renderer));
}

/** Return the anisotropy of textures: Mesa's processor takes 19 seconds for a picture with it, a tenth of one without. */
export function anisotropyFor(renderer: WebGLRenderer): number {
  return /llvmpipe/i.test(nameOf(renderer)) ? 1 : ANISOTROPY;
}

function nameOf(renderer: WebGLRenderer): string {
  const gl = renderer.getContext();
  const named = gl.getExtension("WEBGL_debug_renderer_info");
  return String(gl.getParameter(named ? named.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
}
