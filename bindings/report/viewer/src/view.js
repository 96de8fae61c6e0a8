// The canvas: a perspective camera on an orbit, drawn again when something changes.
import { AmbientLight, Color, DirectionalLight, PerspectiveCamera, Scene, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

// extent: [x, y, z] of the bounding box, which begins at the origin.
export function createView(element, extent) {
  const renderer = new WebGLRenderer({ antialias: true });
  renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
  element.prepend(renderer.domElement);
  const scene = new Scene();
  scene.background = new Color('#eef1f4');
  scene.add(new AmbientLight('#ffffff', 1.6));
  const radius = Math.hypot(...extent) / 2 || 1;
  const camera = new PerspectiveCamera(30, 1, radius / 50, radius * 40);
  const lamp = new DirectionalLight('#ffffff', 2);
  lamp.position.set(0.4, 0.6, 1);
  camera.add(lamp);
  scene.add(camera);
  const controls = new OrbitControls(camera, renderer.domElement);
  controls.target.set(extent[0] / 2, extent[1] / 2, extent[2] / 2);

  const render = () => renderer.render(scene, camera);
  let waiting = false;
  const redraw = () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => { waiting = false; render(); });
  };
  const resize = () => {
    const { clientWidth, clientHeight } = element;
    renderer.setSize(clientWidth, clientHeight, false);
    camera.aspect = clientWidth / Math.max(clientHeight, 1);
    camera.updateProjectionMatrix();
    render();
  };
  // Looks along a slanted direction onto the side which shows most: flat surfaces from above.
  const [x, y, z] = extent;
  const narrow = Math.min(x, y, z);
  const direction = narrow === y && y < 0.5 * Math.min(x, z) ? [0.25, 1, 0.45] : [0.45, 0.3, 1];
  const far = (0.9 * radius) / Math.sin((camera.fov * Math.PI) / 360) / Math.hypot(...direction);
  camera.position.copy(controls.target);
  camera.position.x += direction[0] * far;
  camera.position.y += direction[1] * far;
  camera.position.z += direction[2] * far;
  controls.update();
  controls.addEventListener('change', redraw);
  new ResizeObserver(resize).observe(element);
  resize();
  return { scene, render, redraw, canvas: renderer.domElement };
}
