/**
 * Surfaces that are cheap to draw, for machines without a graphics card: lit at their corners, one texture, one look at the
 * shadow map. The colours come out as those of the full surfaces do, but for their gloss and relief.
 */

import {
  Color,
  type MeshStandardMaterial,
  NoBlending,
  ShaderMaterial,
  type Texture,
  UniformsLib,
  UniformsUtils,
} from "three";

/** What a shadow takes away is told apart only where shadows are drawn: each value that goes from corner to pixel takes time. */
const SHADOWED = /* glsl */ `
  #if defined(USE_SHADOWMAP) && NUM_DIR_LIGHT_SHADOWS > 0
    #define SHADOWED
  #endif`;

const VERTEX = /* glsl */ `
  ${SHADOWED}
  #include <common>
  #include <batching_pars_vertex>
  #include <color_pars_vertex>
  #include <lights_pars_begin>
  #include <shadowmap_pars_vertex>
  #include <fog_pars_vertex>
  uniform vec3 base; uniform float grey;
  varying vec2 vAt; varying vec3 vSky;
  #ifdef SHADOWED
    varying vec3 vSun;
  #endif
  void main() {
    #include <color_vertex>
    // all of a batch lies in the world's own axes (batches.ts): to look its matrices up would take as long as all the rest
    vec4 worldPosition = vec4(position, 1.0);
    vec3 transformedNormal = normal;
    #ifdef USE_INSTANCING
      mat3 turn = mat3(instanceMatrix);
      worldPosition = instanceMatrix * worldPosition;
      transformedNormal = turn * (normal / vec3(dot(turn[0], turn[0]), dot(turn[1], turn[1]), dot(turn[2], turn[2])));
    #endif
    transformedNormal = normalMatrix * transformedNormal;
    vec4 mvPosition = viewMatrix * worldPosition;
    gl_Position = projectionMatrix * mvPosition;
    #include <shadowmap_vertex>
    #include <fog_vertex>
    vec3 upright = normalize(transformedNormal);
    vAt = uv;
    vec3 tint = mix(base * vColor.rgb, vColor.rgb, grey);
    vec3 sky = ambientLightColor;
    #if NUM_HEMI_LIGHTS > 0
      sky += getHemisphereLightIrradiance(hemisphereLights[0], upright);
    #endif
    sky = sky * RECIPROCAL_PI + 0.25 * grey;
    vec3 sun = vec3(0.0);
    #if NUM_DIR_LIGHTS > 0
      sun = directionalLights[0].color * (max(dot(upright, directionalLights[0].direction), 0.0) * RECIPROCAL_PI);
    #endif
    #ifdef SHADOWED
      vSky = tint * sky;
      vSun = tint * sun;
    #else
      vSky = tint * (sky + sun);
    #endif
  }`;

const FRAGMENT = /* glsl */ `
  ${SHADOWED}
  #include <common>
  #include <lights_pars_begin>
  #include <shadowmap_pars_fragment>
  #include <fog_pars_fragment>
  uniform sampler2D map; uniform float grey; uniform float share; uniform float shade;
  varying vec2 vAt; varying vec3 vSky;
  #ifdef SHADOWED
    varying vec3 vSun;
  #endif
  void main() {
    vec3 colour = texture2D(map, vAt).rgb;
    colour = mix(colour, vec3(0.5 + 0.5 * sqrt(dot(colour, vec3(0.2126, 0.7152, 0.0722)))), grey);
    float covers = share;
    #ifdef SHADOWED
      float seen = 1.0;
      vec3 at = vDirectionalShadowCoord[0].xyz;
      at.z += directionalLightShadows[0].shadowBias;
      if (at.x > 0.0 && at.x < 1.0 && at.y > 0.0 && at.y < 1.0 && at.z < 1.0) seen = texture(directionalShadowMap[0], at);
      covers += (1.0 - share) * shade * (1.0 - seen);
      colour *= vSky + vSun * seen;
    #else
      colour *= vSky;
    #endif
    gl_FragColor = vec4(colour * share, covers);
    #include <tonemapping_fragment>
    #include <colorspace_fragment>
    #include <fog_fragment>
  }`;

/** What all plain surfaces of a model share. */
export interface Common {
  readonly grey: { value: number };
  readonly shade: { value: number };
}

/** Return the plain likeness of a surface; `share` is how much of it is drawn, 1 for all. */
export function plainOf(full: MeshStandardMaterial, share: number, common: Common): ShaderMaterial {
  const material = new ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms: {
      ...UniformsUtils.clone(UniformsLib.lights),
      ...UniformsUtils.clone(UniformsLib.fog),
      map: { value: null },
      base: { value: new Color() },
      share: { value: share },
    },
    lights: true,
    fog: true,
    vertexColors: full.vertexColors,
    side: full.side,
  });
  // three reads it, its types do not tell
  Object.assign(material.extensions, { multiDraw: true });
  if (share < 1) material.blending = NoBlending;
  Object.assign(material.uniforms, common);
  relook(material, full);
  return material;
}

/** Take texture and colour anew from the full surface. */
export function relook(plain: ShaderMaterial, full: MeshStandardMaterial): void {
  const { map, base } = plain.uniforms as { map: { value: Texture | null }; base: { value: Color } };
  map.value = full.map;
  base.value.copy(full.color);
}
