// The page of one run: layers that can be switched on and off, beside the figures.
import { readArrays } from './data.js';
import {
  balls, crosses, gridSurface, indexColours, irregularVertices, otherColour, quadSurface, segments, triangleSurface,
} from './layers.js';
import { make, panel } from './panel.js';
import { createView } from './view.js';

// {name: {label, make, points}} of the surfaces which the run made; make() is called when first shown.
function surfacesOf(arrays, geometry) {
  const surfaces = {};
  const { cones } = arrays;
  if (arrays.input_faces) {
    const make = () => triangleSurface(arrays.input_positions, arrays.input_faces);
    surfaces.input = { label: 'Input', make, points: cones };
  }
  if (arrays.grid_faces) {
    const make = () => gridSurface(arrays.grid_positions, arrays.grid_faces, arrays.grid_uv, geometry.uv_scale);
    surfaces.grid = { label: 'Parameter grid', make, points: cones };
  }
  if (arrays.quads_faces) {
    const make = () => quadSurface(arrays.quads_positions, arrays.quads_faces);
    surfaces.quads = { label: 'Quads', make, points: irregularVertices(arrays.quads_positions, arrays.quads_faces) };
  }
  return surfaces;
}

// What can be switched on and off beside the surface.
function overlaysOf(arrays) {
  const overlays = { singularities: { label: 'Singularities', on: true } };
  if (arrays.field) {
    const make = () => crosses(arrays.input_positions, arrays.input_faces, arrays.field);
    overlays.field = { label: 'Field', make, on: false };
  }
  if (arrays.quads_lines?.length) {
    const make = () => segments(arrays.quads_positions, arrays.quads_lines, '#b8002e');
    overlays.features = { label: 'Features', make, on: true };
  }
  overlays.edges = { label: 'Lines', on: true };
  return overlays;
}

function legend(points) {
  const counts = new Map();
  for (let i = 3; i < (points?.length ?? 0); i += 4) counts.set(points[i], (counts.get(points[i]) ?? 0) + 1);
  return [...counts].sort((a, b) => b[0] - a[0]).map(([index, n]) => {
    const dot = make('i');
    dot.style.background = indexColours[index] ?? otherColour;
    const size = Math.abs(index);
    return make('div', {}, dot, `index ${index > 0 ? '+' : '−'}${size % 4 ? `${size}/4` : size / 4}: ${n}`);
  });
}

function choice(type, name, value, label, checked) {
  return make('label', {}, make('input', { type, name, value, checked }), label);
}

export async function showReport(report, text) {
  document.title = `${report.stats.input.file.split('/').at(-1)} – QuadCover`;
  const box = make('main', { className: 'view' });
  document.body.append(make('div', { className: 'report' }, box, panel(report)));
  const { geometry } = report;
  const arrays = await readArrays(geometry.arrays, text);
  const view = createView(box, geometry.extent);
  const surfaces = surfacesOf(arrays, geometry);
  const overlays = overlaysOf(arrays);
  const names = Object.keys(surfaces);
  const start = names.includes('quads') ? 'quads' : names.at(-1);
  const controls = make('form', { className: 'controls' },
    make('fieldset', {}, ...names.map((n) => choice('radio', 'surface', n, surfaces[n].label, n === start))),
    make('fieldset', {}, ...Object.entries(overlays).map(([n, one]) => choice('checkbox', 'layer', n, one.label, one.on))));
  const key = make('div', { className: 'legend' });
  box.append(controls, key);

  // Shows or hides a part of the picture; visible for the first time, it is made.
  const show = (owner, part, visible, create) => {
    if (visible && !owner[part]) view.scene.add((owner[part] = create()));
    if (owner[part]) owner[part].visible = visible;
  };
  const update = () => {
    const form = new FormData(controls);
    const shown = form.get('surface');
    const on = new Set(form.getAll('layer'));
    for (const [name, one] of Object.entries(surfaces)) {
      show(one, 'surface', name === shown, one.make);
      show(one, 'balls', name === shown && on.has('singularities'), () => balls(one.points ?? [], geometry.ball));
    }
    for (const [name, one] of Object.entries(overlays)) if (one.make) show(one, 'object', on.has(name), one.make);
    surfaces[shown].surface.material.uniforms.strength.value = on.has('edges') ? 0.85 : 0;
    key.replaceChildren(...(on.has('singularities') ? legend(surfaces[shown].points) : []));
    view.render();
  };
  controls.addEventListener('change', update);
  update();
  return view;
}
