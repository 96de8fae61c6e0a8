// What is drawn: surfaces whose lines are the integer values of a coordinate, crosses, cones, features.
// Coordinates of a surface: barycentric (edges of triangles), corners of the unit square (edges of
// quads) or the parameters (the grid). All positions are in units of the quantisation.
import {
  BufferAttribute, BufferGeometry, Color, GLSL3, Group, InstancedMesh, LineBasicMaterial, LineSegments, Matrix4, Mesh,
  MeshLambertMaterial, ShaderMaterial, SphereGeometry, DoubleSide,
} from 'three';

const vertexShader = `
in vec3 coordinate;
out vec3 seen, grid;
void main() {
    vec4 p = modelViewMatrix * vec4(position, 1.0);
    seen = p.xyz;
    grid = coordinate;
    gl_Position = projectionMatrix * p;
}`;

// The normal of the flat face comes from the derivatives; it points to the viewer on either side.
const fragmentShader = `
uniform vec3 colour, ink;
uniform float width, strength;
in vec3 seen, grid;
out vec4 result;
void main() {
    vec3 n = normalize(cross(dFdx(seen), dFdy(seen)));
    float light = 0.42 + 0.42 * max(dot(n, normalize(vec3(0.35, 0.55, 0.75))), 0.0) + 0.2 * max(n.z, 0.0);
    vec3 base = gl_FrontFacing ? colour : colour.bgr * 0.75;
    vec3 step = fwidth(grid) + 1e-7;
    vec3 distance = abs(fract(grid - 0.5) - 0.5) / step;
    vec3 fade = clamp(1.6 - 3.0 * step, 0.15, 1.0);
    vec3 line = (1.0 - smoothstep(width - 0.5, width + 0.5, distance)) * fade;
    float drawn = strength * max(line.x, max(line.y, line.z));
    result = vec4(mix(base * light, ink, drawn), 1.0);
    result.rgb = pow(result.rgb, vec3(1.0 / 2.2));
}`;

// triangles: n x 3 vertex numbers; coordinate(i, k) = [x, y, z] at corner k of triangle i.
function surface(position, triangles, coordinate, colour, ink) {
  const n = triangles.length;
  const at = new Float32Array(3 * n);
  const grid = new Float32Array(3 * n);
  for (let i = 0; i < n; i++) {
    const v = 3 * triangles[i];
    at[3 * i] = position[v];
    at[3 * i + 1] = position[v + 1];
    at[3 * i + 2] = position[v + 2];
    coordinate(i, grid, 3 * i);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(at, 3));
  geometry.setAttribute('coordinate', new BufferAttribute(grid, 3));
  const material = new ShaderMaterial({
    glslVersion: GLSL3, vertexShader, fragmentShader, side: DoubleSide,
    polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    uniforms: {
      colour: { value: new Color(colour) }, ink: { value: new Color(ink) },
      width: { value: 0.75 }, strength: { value: 0.85 },
    },
  });
  const mesh = new Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}

export function triangleSurface(position, triangles) {
  return surface(position, triangles, (i, out, o) => { out[o + (i % 3)] = 1; }, '#d9dfe5', '#9aa5b1');
}

// uv: two numbers a corner, in units of 1 / scale.
export function gridSurface(position, triangles, uv, scale) {
  return surface(position, triangles, (i, out, o) => {
    out[o] = uv[2 * i] / scale;
    out[o + 1] = uv[2 * i + 1] / scale;
    out[o + 2] = 0.5;
  }, '#dfe7ef', '#1b5e9b');
}

const square = [0, 0, 1, 0, 1, 1, 0, 1];
const halves = [0, 1, 2, 0, 2, 3];
export function quadSurface(position, quads) {
  const triangles = new Int32Array((quads.length / 4) * 6);
  for (let i = 0; i < triangles.length; i++) triangles[i] = quads[4 * Math.floor(i / 6) + halves[i % 6]];
  return surface(position, triangles, (i, out, o) => {
    const k = halves[i % 6];
    out[o] = square[2 * k];
    out[o + 1] = square[2 * k + 1];
    out[o + 2] = 0.5;
  }, '#f0d9a8', '#3d2f14');
}

const MOST_CROSSES = 12000;

// angle: 256 steps to a quarter turn, counter-clockwise from the edge between corners 1 and 2.
export function crosses(position, triangles, angle) {
  const n = triangles.length / 3;
  const every = Math.ceil(n / MOST_CROSSES);
  const at = new Float32Array(12 * Math.ceil(n / every));
  let o = 0;
  const p = [0, 1, 2].map(() => [0, 0, 0]);
  for (let t = 0; t < n; t += every) {
    for (let k = 0; k < 3; k++) for (let c = 0; c < 3; c++) p[k][c] = position[3 * triangles[3 * t + k] + c];
    o = cross(p, (angle[t] * Math.PI) / 512, Math.sqrt(every), at, o);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(at.subarray(0, o), 3));
  const lines = new LineSegments(geometry, new LineBasicMaterial({ color: '#00574a' }));
  lines.frustumCulled = false;
  return lines;
}

function cross([a, b, c], angle, factor, at, o) {
  const sub = (x, y) => x.map((v, i) => v - y[i]);
  const times = (x, y) => [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
  const e = sub(c, b);
  const n = times(sub(b, a), sub(c, a));
  const area = Math.hypot(...n) / 2;
  const length = Math.hypot(...e);
  if (!(area > 0) || !(length > 0)) return o;
  const f = times(n, e).map((v) => v / (2 * area));
  const half = (0.36 * factor * Math.sqrt(area)) / length;
  for (const turn of [angle, angle + Math.PI / 2]) {
    for (const sign of [-half, half]) {
      for (let i = 0; i < 3; i++) {
        const middle = (a[i] + b[i] + c[i]) / 3;
        at[o++] = middle + sign * (Math.cos(turn) * e[i] + Math.sin(turn) * f[i]);
      }
    }
  }
  return o;
}

export function segments(position, pairs, colour) {
  const at = new Float32Array(3 * pairs.length);
  for (let i = 0; i < pairs.length; i++) for (let c = 0; c < 3; c++) at[3 * i + c] = position[3 * pairs[i] + c];
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(at, 3));
  const lines = new LineSegments(geometry, new LineBasicMaterial({ color: colour }));
  lines.frustumCulled = false;
  return lines;
}

// Valence 3 is red, 5 blue, as in the thesis.
export const indexColours = { 1: '#d7301f', '-1': '#2166ac', 2: '#f28e2b', '-2': '#6a3d9a', 3: '#e7298a', '-3': '#1b9e77', 4: '#b8860b', '-4': '#00838f' };
export const otherColour = '#444444';

// points: x, y, z, index4 in turn.
export function balls(points, radius) {
  const group = new Group();
  const sphere = new SphereGeometry(radius, 14, 10);
  const byIndex = new Map();
  for (let i = 0; i < points.length; i += 4) {
    const list = byIndex.get(points[i + 3]) ?? [];
    list.push(new Matrix4().makeTranslation(points[i], points[i + 1], points[i + 2]));
    byIndex.set(points[i + 3], list);
  }
  for (const [index, list] of byIndex) {
    const material = new MeshLambertMaterial({ color: indexColours[index] ?? otherColour });
    const mesh = new InstancedMesh(sphere, material, list.length);
    list.forEach((m, i) => mesh.setMatrixAt(i, m));
    mesh.frustumCulled = false;
    group.add(mesh);
  }
  return group;
}

// Irregular interior vertices of a quad mesh as points of balls(): index4 = 4 - valence. Around an
// interior vertex the ends of the fan meet: the sum of next - previous vertex numbers vanishes.
export function irregularVertices(position, quads) {
  const valence = new Int32Array(position.length / 3);
  const open = new Float64Array(valence.length);
  for (let i = 0; i < quads.length; i++) {
    const face = i - (i % 4);
    valence[quads[i]]++;
    open[quads[i]] += quads[face + ((i + 1) % 4)] - quads[face + ((i + 3) % 4)];
  }
  const points = [];
  valence.forEach((n, v) => {
    if (n > 0 && n !== 4 && open[v] === 0) points.push(...position.subarray(3 * v, 3 * v + 3), 4 - n);
  });
  return points;
}
