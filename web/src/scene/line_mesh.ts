// A line of the model: one quad per element, as wide as the pipe is but never thinner than asked
// for on the screen, with round ends, coloured by the value at its nodes.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DataTexture,
  FloatType,
  Group,
  Matrix4,
  Mesh,
  NormalBlending,
  RGBAFormat,
  ShaderMaterial,
  Vector2,
} from "three";

const VERTEX = /* glsl */ `
  attribute vec3 corner;
  uniform sampler2D nodes;
  uniform vec2 size;
  uniform float least;
  uniform float extra;
  uniform float back;
  varying vec2 at;
  varying vec2 span;
  varying float value;

  vec4 texel(int index) {
    int width = textureSize(nodes, 0).x;
    return texelFetch(nodes, ivec2(index % width, index / width), 0);
  }

  void main() {
    // corner: number of the element, which of its ends, which side.
    int element = int(corner.x);
    vec4 first = texel(2 * element);
    vec4 second = texel(2 * element + 2);
    float diameter = texel(2 * element + 1).x;
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
    bool end = corner.y > 0.5;
    float w = end ? cb.w : ca.w;
    float half_ = 0.5 * max(least, diameter * projectionMatrix[1][1] * size.y * 0.5 / w) + extra;
    vec2 place = (end ? pb : pa) + direction * (end ? half_ : -half_) + normal * corner.z * half_;
    at = vec2(end ? length_ + half_ : -half_, corner.z * half_);
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
      nodes: { value: null },
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

/** Texels in a row of the texture that holds the nodes. */
const TEXTURE_WIDTH = 1024;
/** Nodes nearer to each other on the screen are drawn as one [px]. */
const NEAREST_PX = 1.5;
/** Difference of value that is always drawn, as a share of the colour range. */
const FINEST_COLOUR = 0.01;

export class LineMesh {
  readonly group = new Group();
  /** x, y, z and value of each node (4 x nodes). */
  readonly nodes: Float32Array;
  /** Per drawn node: x, y, z, value; diameter of the element that begins there. */
  private texels: Float32Array;
  private texture: DataTexture;
  private geometry = new BufferGeometry();
  private body: Mesh<BufferGeometry, ShaderMaterial>;
  private edge: Mesh<BufferGeometry, ShaderMaterial>;

  // The nodes are a texture that every corner reads its element's two ends from. Instances would
  // need no corners, but drawing without a graphics card takes them one by one: ten times longer.
  constructor(
    nodes: number,
    private diameters: Float32Array,
  ) {
    this.nodes = new Float32Array(4 * nodes);
    const width = Math.min(2 * nodes, TEXTURE_WIDTH);
    const height = Math.ceil((2 * nodes) / width);
    this.texels = new Float32Array(4 * width * height);
    this.texture = new DataTexture(this.texels, width, height, RGBAFormat, FloatType);
    const elements = nodes - 1;
    const corners = new Float32Array(12 * elements);
    const order = new Uint32Array(6 * elements);
    for (let k = 0; k < elements; k++) {
      corners.set([k, 0, -1, k, 1, -1, k, 1, 1, k, 0, 1], 12 * k);
      order.set([4 * k, 4 * k + 1, 4 * k + 2, 4 * k, 4 * k + 2, 4 * k + 3], 6 * k);
    }
    this.geometry.setAttribute("corner", new BufferAttribute(corners, 3));
    this.geometry.setIndex(new BufferAttribute(order, 1));
    this.body = new Mesh(this.geometry, material());
    this.edge = new Mesh(this.geometry, material());
    this.edge.material.depthWrite = false;
    for (const [order, mesh] of [this.edge, this.body].entries()) {
      mesh.material.uniforms.nodes.value = this.texture;
      mesh.frustumCulled = false;
      mesh.renderOrder = 10 + order;
      this.group.add(mesh);
    }
  }

  /**
   * Takes over the nodes that can be told apart in a picture. `matrix`: from the scene to clip space,
   * `look.size`: of the picture [px].
   */
  private refine(matrix: Matrix4, look: LineLook): void {
    const { nodes, texels, diameters } = this;
    const m = matrix.elements;
    const count = nodes.length / 4;
    const fine = FINEST_COLOUR * (look.range.y - look.range.x);
    let drawn = 0;
    let [lastX, lastY, lastValue] = [NaN, NaN, NaN];
    for (let node = 0; node < count; node++) {
      const k = 4 * node;
      const [x, y, z, value] = [nodes[k], nodes[k + 1], nodes[k + 2], nodes[k + 3]];
      const w = m[3] * x + m[7] * y + m[11] * z + m[15];
      const px = (0.5 * look.size.x * (m[0] * x + m[4] * y + m[8] * z + m[12])) / w;
      const py = (0.5 * look.size.y * (m[1] * x + m[5] * y + m[9] * z + m[13])) / w;
      const near = Math.abs(px - lastX) + Math.abs(py - lastY) < NEAREST_PX;
      const alike = !(Math.abs(value - lastValue) > fine);
      const ends = node === 0 || node === count - 1;
      if (!ends && w > 0 && near && alike && diameters[node] === diameters[node - 1]) {
        continue;
      }
      [lastX, lastY, lastValue] = [px, py, value];
      const t = 8 * drawn;
      texels[t] = x;
      texels[t + 1] = y;
      texels[t + 2] = z;
      texels[t + 3] = value;
      texels[t + 4] = diameters[Math.min(node, count - 2)];
      drawn++;
    }
    this.geometry.setDrawRange(0, 6 * (drawn - 1));
    this.texture.needsUpdate = true;
  }

  show(look: LineLook, selected: boolean, pixelRatio: number, matrix: Matrix4): void {
    this.refine(matrix, look);
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
    edge.extra.value = (selected ? 1.5 : 0.9) * pixelRatio;
    edge.back.value = 1e-5;
  }

  dispose(): void {
    this.texture.dispose();
    this.geometry.dispose();
    this.body.material.dispose();
    this.edge.material.dispose();
  }
}
