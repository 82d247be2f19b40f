// Sea surface and seabed: discs with a grid of round distances, fading outwards.

import {
  Color,
  CustomBlending,
  DoubleSide,
  Mesh,
  OneFactor,
  OneMinusSrcAlphaFactor,
  PlaneGeometry,
  ShaderMaterial,
  SrcAlphaFactor,
  Vector2,
} from "three";

const VERTEX = /* glsl */ `
  varying vec2 place;
  uniform vec2 centre;
  uniform float radius;
  void main() {
    place = position.xy * radius + centre;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(place, 0.0, 1.0);
  }
`;

const FRAGMENT = /* glsl */ `
  varying vec2 place;
  uniform vec2 centre;
  uniform vec2 shift;
  uniform float radius;
  uniform float spacing;
  uniform vec3 fill;
  uniform vec3 grid;
  uniform float fillOpacity;
  uniform float gridOpacity;

  float lines(vec2 at) {
    vec2 width = fwidth(at);
    vec2 near = abs(fract(at - 0.5) - 0.5);
    vec2 on = 1.0 - smoothstep(vec2(0.0), width * 1.2, near - width * 0.1);
    // Where lines crowd below a few pixels they would only flicker.
    on *= 1.0 - smoothstep(0.15, 0.45, width);
    return max(on.x, on.y);
  }

  void main() {
    float r = distance(place, centre) / radius;
    float fade = 1.0 - smoothstep(0.55, 1.0, r);
    if (fade <= 0.0) discard;
    vec2 at = (place + shift) / spacing;
    float strength = max(lines(at) * 0.75, lines(at / 5.0));
    float alpha = mix(fillOpacity, 1.0, strength * gridOpacity) * fade;
    gl_FragColor = vec4(mix(fill, grid, strength * gridOpacity), alpha);
  }
`;

export class Plane {
  readonly mesh: Mesh<PlaneGeometry, ShaderMaterial>;

  /**
   * The seabed is `behind` all: drawn before anything else. The sea veils what is beyond it and
   * nothing before it: drawn after all solid things.
   */
  constructor(behind: boolean) {
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      transparent: !behind,
      blending: CustomBlending,
      blendSrc: SrcAlphaFactor,
      blendDst: OneMinusSrcAlphaFactor,
      blendSrcAlpha: OneFactor,
      blendDstAlpha: OneMinusSrcAlphaFactor,
      depthWrite: false,
      depthTest: !behind,
      side: DoubleSide,
      uniforms: {
        centre: { value: new Vector2() },
        shift: { value: new Vector2() },
        radius: { value: 1 },
        spacing: { value: 1 },
        fill: { value: new Color() },
        grid: { value: new Color() },
        fillOpacity: { value: 0.2 },
        gridOpacity: { value: 0.5 },
      },
    });
    this.mesh = new Mesh(new PlaneGeometry(2, 2), material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = behind ? -1 : 1;
  }

  /** `shift`: from scene coordinates to the grid's, which stands still in the sea [m]. */
  place(z: number, centre: Vector2, radius: number, spacing: number, shift: Vector2): void {
    this.mesh.position.z = z;
    const { uniforms } = this.mesh.material;
    uniforms.centre.value.copy(centre);
    uniforms.radius.value = radius;
    uniforms.spacing.value = spacing;
    uniforms.shift.value.copy(shift);
  }

  colour(fill: string, grid: string, fillOpacity: number, gridOpacity: number): void {
    const { uniforms } = this.mesh.material;
    uniforms.fill.value.set(fill).convertLinearToSRGB();
    uniforms.grid.value.set(grid).convertLinearToSRGB();
    uniforms.fillOpacity.value = fillOpacity;
    uniforms.gridOpacity.value = gridOpacity;
  }
}
