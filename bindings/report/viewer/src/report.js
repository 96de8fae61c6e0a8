// The page of one run: layers that can be switched on and off, beside the figures.
import { readArrays } from './data.js';
import {
  balls, crosses, gridSurface, indexColours, irregularVertices, otherColour, quadSurface, segments, triangleSurface,
} from './layers.js';
import { make, panel } from './panel.js';
import { createView } from './view.js';

// {surface name: {label, surface, points, lines}} of what the run made.
function surfaces(arrays, geometry, radius) {
  const made = {};
  if (arrays.input_faces) {
    made.input = { label: 'Input', surface: triangleSurface(arrays.input_positions, arrays.input_faces), points: arrays.cones };
  }
  if (arrays.grid_faces) {
    made.grid = {
      label: 'Parameter grid', points: arrays.cones,
      surface: gridSurface(arrays.grid_positions, arrays.grid_faces, arrays.grid_uv, geometry.uv_scale),
    };
  }
  if (arrays.quads_faces) {
    made.quads = {
      label: 'Quads', surface: quadSurface(arrays.quads_positions, arrays.quads_faces),
      points: irregularVertices(arrays.quads_positions, arrays.quads_faces),
    };
  }
  for (const one of Object.values(made)) one.balls = balls(one.points ?? [], radius);
  return made;
}

function legend(points) {
  const counts = new Map();
  for (let i = 3; i < (points?.length ?? 0); i += 4) counts.set(points[i], (counts.get(points[i]) ?? 0) + 1);
  return [...counts].sort((a, b) => b[0] - a[0]).map(([index, n]) => {
    const dot = make('i');
    dot.style.background = indexColours[index] ?? otherColour;
    const sign = index > 0 ? '+' : '−';
    return make('div', {}, dot, `index ${sign}${Math.abs(index)}/4: ${n}`);
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
  const made = surfaces(arrays, geometry, geometry.ball);
  const overlays = { singularities: { label: 'Singularities' } };
  if (arrays.field) {
    overlays.field = { label: 'Field', object: crosses(arrays.input_positions, arrays.input_faces, arrays.field) };
  }
  if (arrays.quads_lines?.length) {
    overlays.features = { label: 'Features', object: segments(arrays.quads_positions, arrays.quads_lines, '#b8002e') };
  }
  overlays.edges = { label: 'Lines' };

  const names = Object.keys(made);
  const start = names.includes('quads') ? 'quads' : names.at(-1);
  const pick = make('fieldset', {}, ...names.map((n) => choice('radio', 'surface', n, made[n].label, n === start)));
  const switches = make('fieldset', {}, ...Object.keys(overlays).map((n) =>
    choice('checkbox', 'layer', n, overlays[n].label, n !== 'field')));
  const controls = make('form', { className: 'controls' }, pick, switches);
  const key = make('div', { className: 'legend' });
  box.append(controls, key);
  for (const one of Object.values(made)) view.scene.add(one.surface, one.balls);
  for (const one of Object.values(overlays)) if (one.object) view.scene.add(one.object);

  const update = () => {
    const shown = new FormData(controls).get('surface');
    const on = new Set(new FormData(controls).getAll('layer'));
    for (const [name, one] of Object.entries(made)) {
      one.surface.visible = name === shown;
      one.surface.material.uniforms.strength.value = on.has('edges') ? 0.85 : 0;
      one.balls.visible = name === shown && on.has('singularities');
    }
    for (const [name, one] of Object.entries(overlays)) if (one.object) one.object.visible = on.has(name);
    key.replaceChildren(...(on.has('singularities') ? legend(made[shown]?.points) : []));
    view.render();
  };
  controls.addEventListener('change', update);
  update();
  return view;
}
