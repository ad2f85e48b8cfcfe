/**
 * Pack GLB files with meshopt compression: node pack.mjs IN OUT [IN OUT …], and say `packed OUT` of each.
 *
 * Triangles and vertices are put in an order that draws fast and packs well; nothing is left out or rounded but normals.
 */

import { NodeIO } from "@gltf-transform/core";
import {
  EXTMeshGPUInstancing,
  EXTMeshoptCompression,
  EXTTextureWebP,
  KHRMeshQuantization,
} from "@gltf-transform/extensions";
import { MeshoptEncoder } from "meshoptimizer";

const files = process.argv.slice(2);
await MeshoptEncoder.ready;
const io = new NodeIO()
  .registerExtensions([EXTMeshGPUInstancing, EXTMeshoptCompression, EXTTextureWebP, KHRMeshQuantization])
  .registerDependencies({ "meshopt.encoder": MeshoptEncoder });

for (let i = 0; i + 1 < files.length; i += 2) {
  const document = await io.read(files[i]);
  for (const mesh of document.getRoot().listMeshes()) for (const primitive of mesh.listPrimitives()) reorder(primitive);
  document
    .createExtension(EXTMeshoptCompression)
    .setRequired(true)
    .setEncoderOptions({ method: EXTMeshoptCompression.EncoderMethod.FILTER });
  await io.write(files[i + 1], document);
  console.log(`packed ${files[i + 1]}`);
}

/** Renumber vertices in the order of their first use, triangles so that a graphics card finds vertices again in its cache. */
function reorder(primitive) {
  const indices = primitive.getIndices();
  if (indices === null) return;
  const triangles = new Uint32Array(indices.getArray());
  const [remap, unique] = MeshoptEncoder.reorderMesh(triangles, true, true); // writes the new numbers into `triangles`
  indices.setArray(unique <= 65535 ? new Uint16Array(triangles) : triangles);
  for (const accessor of primitive.listAttributes()) {
    const before = accessor.getArray();
    const size = accessor.getElementSize();
    const after = new before.constructor(unique * size);
    for (let i = 0; i < remap.length; i++)
      if (remap[i] !== 0xffffffff) after.set(before.subarray(i * size, (i + 1) * size), remap[i] * size);
    accessor.setArray(after);
  }
}
