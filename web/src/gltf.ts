/** The one reader of models: what they are packed with is unpacked beside the page's own thread. three.js only. */

import { MeshoptDecoder } from "three/addons/libs/meshopt_decoder.module.js";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

// a page that was opened as a file may start no worker
if (location.protocol !== "file:") MeshoptDecoder.useWorkers(1);

export const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder);
