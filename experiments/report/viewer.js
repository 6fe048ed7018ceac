// The report's 3-D view: two meshes side by side under one camera. Needs three.js and OrbitControls before it.
(() => {
  'use strict';
  const byId = (id) => document.getElementById('view-' + id);
  const canvas = byId('canvas');
  const specs = JSON.parse(byId('runs').textContent);
  const packed = document.querySelectorAll('script.mesh');
  const geometries = new Map();

  const missing = (why) => { byId('missing').textContent += ' (' + why + ')'; };
  if (!specs.length) return missing('there is no run to show');
  if (!window.DecompressionStream) return missing('this browser cannot inflate the meshes');
  let renderer;
  try {
    const context = canvas.getContext('webgl', {antialias: true, preserveDrawingBuffer: true});
    if (!context) return missing('WebGL is not available');
    renderer = new THREE.WebGLRenderer({canvas, context, antialias: true});
  } catch (error) {
    return missing(error.message);
  }

  // Inverse of report/display_mesh.cpp.
  async function unpack(text) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
    const data = new DataView(await new Response(stream).arrayBuffer());
    const vertices = data.getUint32(0, true), corners = data.getUint32(4, true), step = data.getFloat32(20, true);
    let at = 24;
    const positions = new Float32Array(3 * vertices);
    for (let k = 0; k < 3; ++k, at += 2 * vertices) {
      const low = data.getFloat32(8 + 4 * k, true);
      for (let i = 0, place = 0; i < vertices; ++i) {
        place = (place + data.getUint8(at + i) + 256 * data.getUint8(at + vertices + i)) & 65535;
        positions[3 * i + k] = low + place * step;
      }
    }
    const indices = new Uint32Array(corners);
    for (let i = 0, next = 0; i < corners; ++i) {
      let back = 0;
      for (let byte = 0; byte < 4; ++byte) back += data.getUint8(at + byte * corners + i) * 2 ** (8 * byte);
      indices[i] = next - back;
      if (back === 0) ++next;
    }
    return creased(positions, indices);
  }

  // Smooth within 40 degrees, an edge beyond: every corner has the mean normal of the triangles around its vertex that
  // face as its own does.
  function creased(positions, indices) {
    const first = new Uint32Array(positions.length / 3 + 1), around = new Uint32Array(indices.length);
    for (const v of indices) ++first[v + 1];
    for (let v = 0; v + 1 < first.length; ++v) first[v + 1] += first[v];
    const next = first.slice();
    indices.forEach((v, i) => { around[next[v]++] = Math.floor(i / 3); });

    const corners = new Float32Array(3 * indices.length), normals = new Float32Array(3 * indices.length);
    indices.forEach((v, i) => corners.set(positions.subarray(3 * v, 3 * v + 3), 3 * i));
    const faces = [], a = new THREE.Vector3(), b = new THREE.Vector3(), c = new THREE.Vector3();
    for (let i = 0; i < indices.length; i += 3) {
      a.fromArray(corners, 3 * i), b.fromArray(corners, 3 * i + 3).sub(a), c.fromArray(corners, 3 * i + 6).sub(a);
      const across = new THREE.Vector3().crossVectors(b, c);  // as long as the triangle is large
      faces.push({across, unit: across.clone().normalize()});
    }
    const crease = Math.cos(40 * Math.PI / 180);
    indices.forEach((v, i) => {
      const own = faces[Math.floor(i / 3)].unit, sum = new THREE.Vector3();
      for (let k = first[v]; k < first[v + 1]; ++k)
        if (faces[around[k]].unit.dot(own) > crease) sum.add(faces[around[k]].across);
      sum.normalize().toArray(normals, 3 * i);
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(corners, 3));
    geometry.setAttribute('normal', new THREE.BufferAttribute(normals, 3));
    geometry.computeBoundingSphere();
    return geometry;
  }

  function geometry(number) {
    if (!geometries.has(number)) geometries.set(number, unpack(packed[number].textContent));
    return geometries.get(number);
  }

  const camera = new THREE.PerspectiveCamera(30, 1, 0.01, 100);
  const controls = new THREE.OrbitControls(camera, canvas);
  const sides = ['left', 'right'].map((name) => {
    const scene = new THREE.Scene();
    scene.background = new THREE.Color(0xf4f6f9);
    scene.add(new THREE.HemisphereLight(0xffffff, 0x8a8f99, 0.75));
    const lamp = new THREE.DirectionalLight(0xffffff, 0.5);
    scene.add(lamp, lamp.target);
    return {name, scene, lamp, mesh: null, edges: null, chooser: byId(name), caption: byId(name + '-text')};
  });

  let waiting = false;
  function draw() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      const width = canvas.clientWidth, height = canvas.clientHeight, half = Math.floor(width / 2);
      if (!width || !height) return;
      renderer.setPixelRatio(window.devicePixelRatio || 1);
      renderer.setSize(width, height, false);
      renderer.setScissorTest(true);
      camera.aspect = half / height;
      camera.updateProjectionMatrix();
      const up = new THREE.Vector3(0, 1, 0).applyQuaternion(camera.quaternion);
      sides.forEach((side, i) => {
        side.lamp.position.copy(camera.position).addScaledVector(up, 1);
        side.lamp.target.position.copy(controls.target);
        renderer.setViewport(i * half, 0, half, height);
        renderer.setScissor(i * half, 0, half - (i ? 0 : 1), height);
        renderer.render(side.scene, camera);
      });
    });
  }

  function reset() {
    const shown = sides.find((side) => side.mesh);
    if (!shown) return;
    const sphere = shown.mesh.geometry.boundingSphere, aspect = canvas.clientWidth / 2 / canvas.clientHeight;
    const distance = sphere.radius / Math.sin(camera.fov / 2 * Math.PI / 180) / Math.min(1, aspect);
    controls.target.copy(sphere.center);
    const azimuth = 35 * Math.PI / 180, lift = 22 * Math.PI / 180;
    camera.position.set(Math.sin(azimuth) * Math.cos(lift), Math.sin(lift), Math.cos(azimuth) * Math.cos(lift))
        .multiplyScalar(distance).add(sphere.center);
    camera.near = sphere.radius / 50;
    camera.far = sphere.radius * 50;
    controls.update();
    draw();
  }

  const spec = () => specs[byId('spec').value];
  const model = () => spec().models[byId('model').value];

  async function show(side) {
    const run = model().runs[side.chooser.value];
    for (const old of [side.mesh, side.edges]) if (old) side.scene.remove(old);
    side.mesh = side.edges = null;
    side.caption.textContent = run ? [run.label].concat(run.values || []).join(' · ') : '';
    if (!run || !(run.mesh >= 0)) return draw();
    const shape = await geometry(run.mesh);
    if (model().runs[side.chooser.value] !== run) return;  // another was chosen meanwhile
    side.mesh = new THREE.Mesh(shape, new THREE.MeshStandardMaterial({
      color: 0xb9c2cf, roughness: 0.85, metalness: 0, flatShading: byId('flat').checked, side: THREE.DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1}));
    side.scene.add(side.mesh);
    if (byId('edges').checked) {
      side.edges = new THREE.LineSegments(new THREE.WireframeGeometry(shape), new THREE.LineBasicMaterial({color: 0x3a4252}));
      side.scene.add(side.edges);
    }
    draw();
  }

  function fill(chooser, names, value, unusable) {
    chooser.textContent = '';
    names.forEach((name, i) => {
      const option = new Option(name, i);
      option.disabled = Boolean(unusable && unusable(i));
      chooser.add(option);
    });
    chooser.value = value;
  }

  async function choose_model() {
    const runs = model().runs, none = (i) => !(runs[i].mesh >= 0);
    const names = runs.map((run) => run.label + (run.why ? ': ' + run.why : ''));
    const usable = runs.map((run, i) => i).filter((i) => !none(i));
    const measured = usable.filter((i) => runs[i].label !== 'reference');
    fill(byId('left'), names, measured.length ? measured[measured.length - 1] : usable[0], none);
    fill(byId('right'), names, usable[usable.length - 1], none);
    await Promise.all(sides.map(show));
    reset();
  }

  function choose_spec() {
    fill(byId('model'), spec().models.map((m) => m.name), 0);
    return choose_model();
  }

  byId('missing').hidden = true;
  document.getElementById('view').hidden = false;
  fill(byId('spec'), specs.map((s) => s.title), 0);
  byId('spec').onchange = choose_spec;
  byId('model').onchange = choose_model;
  for (const side of sides) side.chooser.onchange = () => show(side);
  byId('edges').onchange = byId('flat').onchange = () => sides.forEach(show);
  byId('reset').onclick = reset;
  controls.addEventListener('change', draw);
  window.addEventListener('resize', draw);
  choose_spec().then(() => { canvas.dataset.state = 'drawn'; });
})();
