/** Many small geometries as one, in the axes of the world. */

import { BufferAttribute, BufferGeometry, Matrix3, type Matrix4, Vector3 } from "three";

/** A geometry and where it lies. */
export interface Laid {
  readonly geometry: BufferGeometry;
  readonly T_world_geometry: Matrix4;
}

/** What every geometry of the models has; others cannot be merged. */
export const MERGED_ATTRIBUTES = ["position", "normal", "uv", "color"] as const;

/** Return whether a geometry can be merged. */
export function isMergeable(geometry: BufferGeometry): boolean {
  return geometry.index !== null && MERGED_ATTRIBUTES.every((name) => geometry.hasAttribute(name));
}

/** Return all of them as one geometry: positions as floats, normals and colours as bytes. */
export function merged(parts: readonly Laid[]): BufferGeometry {
  const vertices = parts.reduce((sum, { geometry }) => sum + geometry.getAttribute("position").count, 0);
  const corners = parts.reduce((sum, { geometry }) => sum + (geometry.index?.count ?? 0), 0);
  const positions = new Float32Array(3 * vertices);
  const normals = new Int8Array(4 * vertices);
  const uvs = new Float32Array(2 * vertices);
  const colours = new Uint8Array(4 * vertices);
  const indices = new Uint32Array(corners);
  const point = new Vector3();
  const turn = new Matrix3();
  let vertex = 0;
  let corner = 0;
  for (const { geometry, T_world_geometry } of parts) {
    const { position, normal, uv, color } = geometry.attributes;
    const { index } = geometry;
    if (!position || !normal || !uv || !color || !index) throw new Error("a geometry that cannot be merged");
    turn.getNormalMatrix(T_world_geometry);
    for (let i = 0; i < index.count; i++) indices[corner++] = vertex + index.getX(i);
    for (let i = 0; i < position.count; i++, vertex++) {
      point
        .fromBufferAttribute(position, i)
        .applyMatrix4(T_world_geometry)
        .toArray(positions, 3 * vertex);
      point.fromBufferAttribute(normal, i).applyMatrix3(turn).normalize().multiplyScalar(127).round();
      point.toArray(normals, 4 * vertex);
      uvs[2 * vertex] = uv.getX(i);
      uvs[2 * vertex + 1] = uv.getY(i);
      colours[4 * vertex] = Math.round(255 * color.getX(i));
      colours[4 * vertex + 1] = Math.round(255 * color.getY(i));
      colours[4 * vertex + 2] = Math.round(255 * color.getZ(i));
      colours[4 * vertex + 3] = 255;
    }
  }
  const whole = new BufferGeometry();
  whole.setAttribute("position", new BufferAttribute(positions, 3));
  whole.setAttribute("normal", new BufferAttribute(normals, 4, true));
  whole.setAttribute("uv", new BufferAttribute(uvs, 2));
  whole.setAttribute("color", new BufferAttribute(colours, 4, true));
  whole.setIndex(new BufferAttribute(indices, 1));
  return whole;
}
