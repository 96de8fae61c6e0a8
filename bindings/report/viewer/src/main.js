// The page holds either a run (#report, #geometry) or a list of runs (#gallery). `quadcover.ready` on
// the window is for scripts which drive the page.
import { showGallery } from './gallery.js';
import { make } from './panel.js';
import { showReport } from './report.js';

const text = (id) => document.getElementById(id)?.textContent;

async function show() {
  const gallery = text('gallery');
  if (gallery) return showGallery(JSON.parse(gallery));
  return showReport(JSON.parse(text('report')), text('geometry'));
}

// ready: the view, as soon as everything has been drawn once.
window.quadcover = { ready: show() };
window.quadcover.ready.catch((error) => {
  document.body.append(make('p', { className: 'warning' }, `Cannot show this run: ${error.message}`));
});
