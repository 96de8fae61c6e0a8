// Histograms (thesis, Figure 7.1) and curves over evaluations (Figure 6.1) as SVG.
const space = 'http://www.w3.org/2000/svg';
const WIDTH = 360, HEIGHT = 130, LEFT = 30, RIGHT = 30, TOP = 8, BOTTOM = 18;

function add(parent, name, attributes, text) {
  const node = document.createElementNS(space, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  if (text !== undefined) node.textContent = text;
  parent.append(node);
  return node;
}

function frame(label) {
  const svg = document.createElementNS(space, 'svg');
  svg.setAttribute('viewBox', `0 0 ${WIDTH} ${HEIGHT}`);
  svg.setAttribute('role', 'img');
  svg.setAttribute('aria-label', label);
  add(svg, 'path', { d: `M${LEFT} ${HEIGHT - BOTTOM}H${WIDTH - RIGHT}`, stroke: '#98a3ae', fill: 'none' });
  return svg;
}

const atX = (x, lo, hi) => LEFT + ((x - lo) / (hi - lo || 1)) * (WIDTH - LEFT - RIGHT);
const atY = (y, hi) => HEIGHT - BOTTOM - (y / (hi || 1)) * (HEIGHT - TOP - BOTTOM);
const short = (x) => Number(x.toPrecision(3)).toString();

function ticks(svg, lo, hi, unit) {
  for (let k = 0; k <= 4; k++) {
    const x = lo + (k * (hi - lo)) / 4;
    add(svg, 'text', { x: atX(x, lo, hi), y: HEIGHT - 5, 'text-anchor': 'middle' }, short(x) + unit);
  }
}

// histogram: {lo, hi, count: [...]}; what lies outside is in the first and last bin.
export function histogramPlot(histogram, label, unit, mark) {
  const { lo, hi, count } = histogram;
  const svg = frame(label);
  const most = Math.max(...count);
  const width = (WIDTH - LEFT - RIGHT) / count.length;
  count.forEach((n, i) => {
    const y = atY(n, most);
    add(svg, 'rect', { x: LEFT + i * width, y, width: Math.max(width - 0.6, 0.4), height: HEIGHT - BOTTOM - y, fill: '#4f7cac' });
  });
  const x = atX(mark, lo, hi);
  add(svg, 'path', { d: `M${x} ${TOP}V${HEIGHT - BOTTOM}`, stroke: '#c33', 'stroke-dasharray': '3 3' });
  ticks(svg, lo, hi, unit);
  return svg;
}

function polyline(svg, points, most, end, colour) {
  const d = points.map(([x, y], i) => `${i ? 'L' : 'M'}${atX(x, 0, end).toFixed(1)} ${atY(y, most).toFixed(1)}`);
  add(svg, 'path', { d: d.join(''), stroke: colour, fill: 'none', 'stroke-width': 1.4 });
}

// trace: [{step, curves: {E_D_rel: [[x, y], ...], branch_points: [...]}}], one after the other; E_D in
// percent of the field.
export function tracePlot(trace) {
  const svg = frame('Distortion and number of branch points over evaluations');
  const energy = [], points = [], starts = [];
  let begin = 0;
  for (const { step, curves } of trace) {
    starts.push([begin, step]);
    energy.push(...curves.E_D_rel.map(([x, y]) => [begin + x, y]));
    points.push(...curves.branch_points.map(([x, y]) => [begin + x, y]));
    begin = energy.at(-1)[0];
  }
  const mostEnergy = Math.max(...energy.map((p) => p[1]));
  const mostPoints = Math.max(...points.map((p) => p[1]));
  let free = 0;
  for (const [x, step] of starts) {
    const at = atX(x, 0, begin);
    add(svg, 'path', { d: `M${at} ${TOP}V${HEIGHT - BOTTOM}`, stroke: '#d8dee5' });
    if (at < free) continue;
    add(svg, 'text', { x: at + 2, y: HEIGHT - BOTTOM - 3 }, step);
    free = at + 6 * (step.length + 1);
  }
  polyline(svg, energy, mostEnergy, begin, '#c33');
  polyline(svg, points, mostPoints, begin, '#2166ac');
  add(svg, 'text', { x: 0, y: TOP + 8 }, `${short(mostEnergy)}%`);
  add(svg, 'text', { x: WIDTH, y: TOP + 8, 'text-anchor': 'end' }, mostPoints);
  ticks(svg, 0, begin, '');
  return svg;
}
