// A line of the model: one quad per element, as wide as the pipe is but never thinner than asked
// for on the screen, with round ends, coloured by the value at its nodes.

import {
  DataTexture,
  Group,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  InstancedInterleavedBuffer,
  InterleavedBufferAttribute,
  BufferAttribute,
  DynamicDrawUsage,
  Mesh,
  ShaderMaterial,
  Vector2,
  Color,
  NormalBlending,
} from "three";

const VERTEX = /* glsl */ `
  attribute vec4 first;
  attribute vec4 second;
  attribute float diameter;
  uniform vec2 size;
  uniform float least;
  uniform float extra;
  uniform float back;
  varying vec2 at;
  varying vec2 span;
  varying float value;

  void main() {
    vec4 a = modelViewMatrix * vec4(first.xyz, 1.0);
    vec4 b = modelViewMatrix * vec4(second.xyz, 1.0);
    float va = first.w;
    float vb = second.w;
    bool perspective = projectionMatrix[2][3] == -1.0;
    if (perspective) {
      // What is behind the camera is cut off at the near plane.
      float near = 0.5 * projectionMatrix[3][2] / projectionMatrix[2][2];
      near = min(near, -1e-4);
      if (a.z > near && b.z > near) { gl_Position = vec4(0.0, 0.0, 2.0, 1.0); return; }
      if (a.z > near) { float s = (near - a.z) / (b.z - a.z); a = mix(a, b, s); va = mix(va, vb, s); }
      if (b.z > near) { float s = (near - b.z) / (a.z - b.z); b = mix(b, a, s); vb = mix(vb, va, s); }
    }
    vec4 ca = projectionMatrix * a;
    vec4 cb = projectionMatrix * b;
    vec3 na = ca.xyz / ca.w;
    vec3 nb = cb.xyz / cb.w;
    if (!(abs(na.x) < 1e6 && abs(nb.x) < 1e6)) { gl_Position = vec4(0.0, 0.0, 2.0, 1.0); return; }
    vec2 pa = na.xy * 0.5 * size;
    vec2 pb = nb.xy * 0.5 * size;
    vec2 along = pb - pa;
    float length_ = length(along);
    vec2 direction = length_ > 1e-6 ? along / length_ : vec2(1.0, 0.0);
    vec2 normal = vec2(-direction.y, direction.x);
    bool end = position.x > 0.5;
    float w = end ? cb.w : ca.w;
    float half_ = 0.5 * max(least, diameter * projectionMatrix[1][1] * size.y * 0.5 / w) + extra;
    vec2 place = (end ? pb : pa) + direction * (end ? half_ : -half_) + normal * position.y * half_;
    at = vec2(end ? length_ + half_ : -half_, position.y * half_);
    span = vec2(length_, half_);
    value = end ? vb : va;
    gl_Position = vec4(place / (0.5 * size), (end ? nb.z : na.z) + back, 1.0);
  }
`;

const FRAGMENT = /* glsl */ `
  uniform sampler2D map;
  uniform vec2 range;
  uniform vec3 plain;
  uniform float mapped;
  uniform float shaded;
  varying vec2 at;
  varying vec2 span;
  varying float value;

  void main() {
    float beyond = max(max(-at.x, at.x - span.x), 0.0);
    float r = length(vec2(beyond, at.y));
    // Round ends meet those of the neighbours: softened there, every joint would shine through.
    float alpha = beyond > 0.0 ? step(r, span.y - 0.5) : 1.0 - smoothstep(span.y - 1.0, span.y, r);
    if (alpha < 0.02) discard;
    vec3 colour = plain;
    if (mapped > 0.5) {
      float share = (value - range.x) / max(range.y - range.x, 1e-30);
      colour = value == value ? texture2D(map, vec2(clamp(share, 0.002, 0.998), 0.5)).rgb : vec3(0.55);
    }
    float across = min(abs(at.y) / span.y, 1.0);
    float light = mix(1.0, 0.72 + 0.36 * sqrt(1.0 - across * across), shaded);
    gl_FragColor = vec4(min(colour * light, 1.0), alpha);
  }
`;

/** What all lines share. */
export interface LineLook {
  map: DataTexture;
  range: Vector2;
  size: Vector2;
  /** Least width on the screen [px]. */
  least: number;
  /** Colour instead of the map. */
  plain: Color | null;
  outline: Color;
  mark: Color;
}

function material(): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    transparent: true,
    blending: NormalBlending,
    uniforms: {
      map: { value: null },
      range: { value: new Vector2(0, 1) },
      size: { value: new Vector2(1, 1) },
      least: { value: 3 },
      extra: { value: 0 },
      back: { value: 0 },
      plain: { value: new Color() },
      mapped: { value: 1 },
      shaded: { value: 1 },
    },
  });
}

export class LineMesh {
  readonly group = new Group();
  /** x, y, z and value of each node (4 x nodes). */
  readonly nodes: Float32Array;
  private buffer: InstancedInterleavedBuffer;
  private body: Mesh<InstancedBufferGeometry, ShaderMaterial>;
  private edge: Mesh<InstancedBufferGeometry, ShaderMaterial>;

  constructor(nodes: number, diameters: Float32Array) {
    this.nodes = new Float32Array(4 * nodes);
    this.buffer = new InstancedInterleavedBuffer(this.nodes, 4, 1);
    this.buffer.setUsage(DynamicDrawUsage);
    const geometry = new InstancedBufferGeometry();
    const corners = new Float32Array([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0]);
    geometry.setAttribute("position", new BufferAttribute(corners, 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    geometry.setAttribute("first", new InterleavedBufferAttribute(this.buffer, 4, 0));
    // The next node of the same buffer: each is stored once.
    geometry.setAttribute("second", new InterleavedBufferAttribute(this.buffer, 4, 4));
    geometry.setAttribute("diameter", new InstancedBufferAttribute(diameters, 1));
    geometry.instanceCount = nodes - 1;
    this.body = new Mesh(geometry, material());
    this.edge = new Mesh(geometry, material());
    this.edge.material.depthWrite = false;
    for (const [order, mesh] of [this.edge, this.body].entries()) {
      mesh.frustumCulled = false;
      mesh.renderOrder = 10 + order;
      this.group.add(mesh);
    }
  }

  /** The nodes have changed. */
  touch(): void {
    this.buffer.needsUpdate = true;
  }

  show(look: LineLook, selected: boolean, pixelRatio: number): void {
    for (const mesh of [this.body, this.edge]) {
      const { uniforms } = mesh.material;
      uniforms.size.value.copy(look.size);
      uniforms.least.value = look.least * pixelRatio;
    }
    const { uniforms } = this.body.material;
    uniforms.map.value = look.map;
    uniforms.range.value.copy(look.range);
    uniforms.mapped.value = look.plain ? 0 : 1;
    uniforms.plain.value.copy(look.plain ?? look.outline);
    uniforms.shaded.value = look.least >= 3 ? 1 : 0;
    const edge = this.edge.material.uniforms;
    edge.plain.value.copy(selected ? look.mark : look.outline);
    edge.mapped.value = 0;
    edge.shaded.value = 0;
    edge.extra.value = (selected ? 1.8 : 0.9) * pixelRatio;
    edge.back.value = 1e-5;
  }

  dispose(): void {
    this.body.geometry.dispose();
    this.body.material.dispose();
    this.edge.material.dispose();
  }
}
