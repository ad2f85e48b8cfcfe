/** What covers all that is drawn to, from edge to edge: pictures are worked on by drawing it. three.js only. */

import { type Material, Mesh, OrthographicCamera, PlaneGeometry, Scene, type WebGLRenderer } from "three";

export class Quad {
  readonly scene = new Scene();
  readonly camera = new OrthographicCamera();
  private readonly mesh: Mesh;

  constructor(material?: Material) {
    this.mesh = new Mesh(new PlaneGeometry(2, 2), material);
    this.mesh.frustumCulled = false;
    this.scene.add(this.mesh);
  }

  /** Cover it with this from now on. */
  set material(material: Material) {
    this.mesh.material = material;
  }

  draw(renderer: WebGLRenderer): void {
    renderer.render(this.scene, this.camera);
  }
}
