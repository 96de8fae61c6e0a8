// The column of figures: what went in, what came out, times, parameters.
import { histogramPlot, tracePlot } from './plots.js';

export function make(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  Object.assign(node, attributes);
  node.append(...children);
  return node;
}

const number = (x, digits = 3) => (x === null || x === undefined ? '–' : Number(x.toPrecision(digits)).toLocaleString('en'));
const count = (n) => n.toLocaleString('en');

function table(rows) {
  return make('table', {}, ...rows.map((row) => make('tr', {}, ...row.map((cell) => make('td', {}, cell)))));
}

function section(title, ...children) {
  return [make('h2', {}, title), ...children];
}

function figures(stats) {
  const { input, quads, energy, uv, field } = stats;
  const given = ['Input', `${count(input.faces)} faces, genus ${input.genus}, ${input.boundaries} boundary loops`];
  if (quads.faces === 0) return table([given]);
  const rows = [
    given,
    ['Quads', count(quads.faces)],
    ['Vertices', count(quads.vertices)],
    ['Irregular vertices', count(quads.irregular)],
    ['Singularities of the field', count(field.singularities)],
    ['Edge length, relative deviation', `${number(quads.rsd_edge)} %`],
    ['Corner angle, relative deviation', `${number(quads.rsd_angle)} %`],
    ['ARAP energy', number(uv.arap_mean)],
    ['Curl E_D', `${number(energy.E_D_rel)} %`],
    ['Rounding E_H', `${number(energy.E_H_rel)} % (direct ${number(energy.E_H_direct_rel)} %)`],
    ['Smallest scaled Jacobian', number(quads.min_scaled_jacobian)],
    ['Hausdorff distance / diagonal', number(quads.hausdorff_rel)],
  ];
  if (quads.components > 1) rows.splice(1, 0, ['Components', count(quads.components)]);
  return table(rows);
}

function times(seconds) {
  const list = [['read', seconds.read], ...Object.entries(seconds.stages), ['write', seconds.write]];
  const most = Math.max(...list.map(([, s]) => s)) || 1;
  const rows = list.map(([name, s]) => {
    const bar = make('i');
    bar.style.width = `${(100 * s) / most}%`;
    return make('tr', {}, make('td', {}, name), make('td', { className: 'share' }, bar), make('td', {}, `${s.toFixed(3)} s`));
  });
  return make('table', {}, ...rows);
}

function parameters(pipeline) {
  return pipeline.stages.map((step) => {
    const rows = Object.entries(step.params ?? {}).map(([key, value]) => [key, String(value)]);
    return make('details', {}, make('summary', {}, step.as ?? step.stage, make('span', {}, step.stage)), table(rows));
  });
}

export function panel(report) {
  const { stats, histograms, trace, command } = report;
  const name = stats.input.file.split('/').at(-1);
  const side = make('aside', { className: 'panel' }, make('h1', {}, name));
  side.append(make('p', {}, `QuadCover ${stats.quadcover}, mode ${stats.mode}, ${number(stats.seconds.total)} s, ${number(stats.peak_rss_mb)} MB`));
  for (const line of stats.warnings) side.append(make('p', { className: 'warning' }, line));
  side.append(...section('Figures', figures(stats)));
  if (histograms) {
    side.append(...section('Edge lengths / mean', histogramPlot(histograms.edge, 'Histogram of edge lengths', '', 1)));
    side.append(...section('Angles', histogramPlot(histograms.angle, 'Histogram of angles', '°', 90)));
  }
  const optimisation = trace.filter(({ curves }) => curves.E_D_rel);
  if (optimisation.length > 0) {
    side.append(...section('Distortion (red) and branch points (blue) over evaluations', tracePlot(optimisation)));
  }
  side.append(...section('Times', times(stats.seconds)));
  if (stats.pipeline) side.append(...section('Parameters', ...parameters(stats.pipeline)));
  side.append(...section('Command', make('code', {}, command)));
  return side;
}
