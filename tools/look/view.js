/* The animated view of a report: needs THREE and THREE.OrbitControls, and `views` as view.py makes them. */
"use strict";
(function () {
  const views = JSON.parse(document.getElementById("views").textContent);
  const holder = document.getElementById("view");
  const $ = (id) => document.getElementById(id);

  /* --- decoding ------------------------------------------------------------------------------------------------ */
  function bytes(text) {
    const raw = atob(text);
    const out = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; ++i) out[i] = raw.charCodeAt(i);
    return out.buffer;
  }
  const floats = (text) => new Float32Array(bytes(text));
  function quantised(q) {
    const coded = new Uint16Array(bytes(q.values));
    const out = new Float32Array(coded.length);
    const scale = (q.high - q.low) / 65535;
    for (let i = 0; i < coded.length; ++i) out[i] = q.low + scale * coded[i];
    return out;
  }

  /* --- colours: viridis ------------------------------------------------------------------------------------------ */
  const stops = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];
  function colour(x, out, at) {
    const s = Math.min(Math.max(x, 0), 1) * (stops.length - 1);
    const i = Math.min(Math.floor(s), stops.length - 2);
    for (let k = 0; k < 3; ++k) out[at + k] = (stops[i][k] + (s - i) * (stops[i + 1][k] - stops[i][k])) / 255;
  }
  const bodyColours = [0x8fa3b8, 0xb8a88f, 0x93b59a, 0xb894a6, 0x9a97bd, 0xbdb08a];

  /* --- scene --------------------------------------------------------------------------------------------------- */
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  } catch (error) {
    holder.innerHTML = '<p class="notice">This browser has no WebGL: the animated view cannot be shown. The plots below tell the rest.</p>';
    document.body.dataset.view = "no-webgl";
    return;
  }
  renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
  renderer.setClearColor(0xf7f8fa);
  holder.insertBefore(renderer.domElement, holder.firstChild);
  const camera = new THREE.PerspectiveCamera(32, 1, 0.01, 1000);
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  controls.screenSpacePanning = true;
  let scene, current, frame = 0, clock = 0, playing = false, last = 0;

  function lit() {
    const made = new THREE.Scene();
    made.add(new THREE.HemisphereLight(0xffffff, 0x9aa0a8, 0.75));
    const sun = new THREE.DirectionalLight(0xffffff, 0.55);
    sun.position.set(0.5, 1, 0.8);
    const fill = new THREE.DirectionalLight(0xffffff, 0.2);
    fill.position.set(-1, 0.3, -0.6);
    made.add(sun, fill);
    return made;
  }

  function buildBodies(view) {
    return view.bodies.map((body, i) => {
      const group = new THREE.Group();
      const geometry = new THREE.BoxBufferGeometry(2 * body.half[0], 2 * body.half[1], 2 * body.half[2]);
      geometry.translate(body.centre[0], body.centre[1], body.centre[2]);
      const material = new THREE.MeshLambertMaterial({ color: bodyColours[i % bodyColours.length], transparent: true, opacity: view.lines.length ? 0.5 : 0.85, depthWrite: !view.lines.length });
      group.add(new THREE.Mesh(geometry, material));
      group.add(new THREE.LineSegments(new THREE.EdgesGeometry(geometry), new THREE.LineBasicMaterial({ color: 0x4a5562 })));
      scene.add(group);
      return { group, position: floats(body.position), quaternion: floats(body.quaternion) };
    });
  }

  function buildLines(view, size) {
    const unit = new THREE.CylinderBufferGeometry(1, 1, 1, 20, 1);
    unit.rotateX(Math.PI / 2);
    return view.lines.map((line) => {
      const mesh = new THREE.Mesh(unit, new THREE.MeshLambertMaterial({ color: 0x666666 }));
      scene.add(mesh);
      const fields = {};
      for (const name of Object.keys(line.fields)) fields[name] = { values: floats(line.fields[name].values), unit: line.fields[name].unit };
      return { line, mesh, fields, radius: line.radius > 0 ? line.radius : 0.006 * size };
    });
  }

  function buildSurfaces(view) {
    return view.surfaces.map((surface) => {
      const quads = new Uint32Array(bytes(surface.faces));
      const corners = [], edges = [];
      for (let i = 0; i < quads.length; i += 4) {
        const [a, b, c, d] = [quads[i], quads[i + 1], quads[i + 2], quads[i + 3]];
        corners.push(a, b, c, a, c, d);
        edges.push(a, b, b, c, c, d, d, a);
      }
      const place = new THREE.BufferAttribute(new Float32Array(3 * surface.nodes), 3);
      const tint = new THREE.BufferAttribute(new Float32Array(3 * surface.nodes), 3);
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", place);
      geometry.setAttribute("color", tint);
      geometry.setIndex(corners);
      const wire = new THREE.BufferGeometry();
      wire.setAttribute("position", place);
      wire.setIndex(edges);
      const material = new THREE.MeshLambertMaterial({ vertexColors: THREE.VertexColors, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
      const mesh = new THREE.Mesh(geometry, material);
      const grid = new THREE.LineSegments(wire, new THREE.LineBasicMaterial({ color: 0x223344, transparent: true, opacity: 0.28 }));
      mesh.frustumCulled = grid.frustumCulled = false;
      scene.add(mesh, grid);
      const fields = {};
      for (const name of Object.keys(surface.fields)) fields[name] = { values: quantised(surface.fields[name]), unit: surface.fields[name].unit };
      return { surface, geometry, place, tint, grid, fields, position: quantised(surface.position) };
    });
  }

  function buildJoints(view, size) {
    const ball = new THREE.SphereBufferGeometry(0.012 * size, 20, 14);
    return view.joints.map((joint) => {
      const mesh = new THREE.Mesh(ball, new THREE.MeshLambertMaterial({ color: 0x30363d }));
      scene.add(mesh);
      return { joint, mesh };
    });
  }

  /* --- places at a frame --------------------------------------------------------------------------------------- */
  const v = new THREE.Vector3();
  function placed(point) {
    v.set(point.at[0], point.at[1], point.at[2]);
    return (point.body < 0 ? v : v.applyMatrix4(current.bodies[point.body].group.matrix)).clone();
  }
  function nearest(list, value) {
    let best = 0;
    for (let i = 1; i < list.length; ++i) if (Math.abs(list[i] - value) < Math.abs(list[best] - value)) best = i;
    return best;
  }

  function show(index) {
    frame = Math.min(Math.max(index, 0), current.view.frames.length - 1);
    const name = $("colour").value;
    current.bodies.forEach((body) => {
      body.group.position.fromArray(body.position, 3 * frame);
      body.group.quaternion.fromArray(body.quaternion, 4 * frame);
      body.group.updateMatrix();
    });
    current.joints.forEach((each) => each.mesh.position.copy(placed(each.joint.at)));
    current.lines.forEach((each) => placeLine(each, name));
    current.surfaces.forEach((each) => placeSurface(each, name));
    const x = current.view.frames[frame];
    $("slider").value = frame;
    $("time").textContent = current.view.axis + " = " + Number(x.toPrecision(5)) + (current.view.unit ? " " + current.view.unit : "");
    renderer.render(scene, camera);
  }

  function ranked(value) {
    const span = current.range[1] - current.range[0];
    return span > 0 ? (value - current.range[0]) / span : 0.5;
  }
  const tint3 = [0, 0, 0];
  function placeLine(each, name) {
    let a, b;
    if (each.line.isolated) {
      const half = 0.5 * each.fields.length.values[frame];
      b = new THREE.Vector3().fromArray(each.line.axis).multiplyScalar(half);
      a = b.clone().negate();
    } else {
      a = placed(each.line.ends[0]);
      b = placed(each.line.ends[1]);
    }
    const length = a.distanceTo(b);
    // The volume of a muscle stays.
    const stretch = each.fields.stretch ? each.fields.stretch.values[frame] : 1;
    const radius = each.radius / Math.sqrt(Math.max(stretch, 0.05));
    each.mesh.position.copy(a).add(b).multiplyScalar(0.5);
    each.mesh.scale.set(radius, radius, Math.max(length, 1e-9));
    each.mesh.up.set(0.13, 0.57, 0.81);
    each.mesh.lookAt(b);
    if (each.fields[name]) {
      colour(ranked(each.fields[name].values[frame]), tint3, 0);
      each.mesh.material.color.setRGB(tint3[0], tint3[1], tint3[2]);
    } else {
      each.mesh.material.color.setHex(0x777f88);
    }
  }
  function placeSurface(each, name) {
    const n = each.surface.nodes;
    const own = nearest(each.surface.frames, current.view.frames[frame]);
    each.place.array.set(each.position.subarray(3 * n * own, 3 * n * (own + 1)));
    each.place.needsUpdate = true;
    const field = each.fields[name];
    for (let i = 0; i < n; ++i) {
      if (field) colour(ranked(field.values[n * own + i]), each.tint.array, 3 * i);
      else each.tint.array.set([0.62, 0.67, 0.72], 3 * i);
    }
    each.tint.needsUpdate = true;
    each.geometry.computeVertexNormals();
  }

  /* --- extents, colours, camera ---------------------------------------------------------------------------------- */
  function extent(view) {
    const box = new THREE.Box3();
    const q = new THREE.Quaternion(), p = new THREE.Vector3();
    view.bodies.forEach((body) => {
      const positions = floats(body.position), turns = floats(body.quaternion);
      for (let f = 0; f < view.frames.length; f += Math.max(1, Math.floor(view.frames.length / 40))) {
        for (let c = 0; c < 8; ++c) {
          p.set(body.centre[0] + (c & 1 ? 1 : -1) * body.half[0], body.centre[1] + (c & 2 ? 1 : -1) * body.half[1], body.centre[2] + (c & 4 ? 1 : -1) * body.half[2]);
          box.expandByPoint(p.applyQuaternion(q.fromArray(turns, 4 * f)).add(v.fromArray(positions, 3 * f)));
        }
      }
    });
    view.lines.forEach((line) => {
      line.ends.forEach((end) => { if (end.body < 0 && !line.isolated) box.expandByPoint(v.fromArray(end.at)); });
      if (line.isolated) {
        const longest = floats(line.fields.length.values).reduce((a, b) => Math.max(a, b), 0);
        const radius = new THREE.Vector3(1, 1, 1).multiplyScalar(line.radius);
        [-0.5, 0.5].forEach((s) => {
          p.fromArray(line.axis).multiplyScalar(s * longest);
          box.expandByPoint(p.clone().add(radius)).expandByPoint(p.clone().sub(radius));
        });
      }
    });
    view.surfaces.forEach((surface) => {
      const positions = quantised(surface.position);
      for (let i = 0; i < positions.length; i += 3) box.expandByPoint(v.fromArray(positions, i));
    });
    return box;
  }

  function colourNames() {
    const names = [];
    const add = (each) => Object.keys(each.fields).forEach((name) => { if (names.indexOf(name) < 0) names.push(name); });
    current.lines.forEach(add);
    current.surfaces.forEach(add);
    return names;
  }
  function range(name) {
    let low = Infinity, high = -Infinity, unit = "";
    current.lines.concat(current.surfaces).forEach((each) => {
      const field = each.fields[name];
      if (!field) return;
      unit = field.unit;
      for (let i = 0; i < field.values.length; ++i) {
        if (field.values[i] < low) low = field.values[i];
        if (field.values[i] > high) high = field.values[i];
      }
    });
    return [low, high, unit];
  }
  function recolour() {
    const name = $("colour").value;
    current.range = range(name);
    const [low, high, unit] = current.range;
    $("bar").style.visibility = low <= high ? "visible" : "hidden";
    $("low").textContent = Number(low.toPrecision(4));
    $("high").textContent = Number(high.toPrecision(4));
    $("quantity").textContent = name + (unit && unit !== "1" ? " (" + unit + ")" : "");
  }

  function resetCamera() {
    const box = current.box;
    const centre = box.getCenter(new THREE.Vector3());
    // What lies in one plane is looked at almost along its normal.
    const size = box.getSize(new THREE.Vector3());
    const flat = size.z < 0.4 * Math.max(size.x, size.y);
    const direction = flat ? new THREE.Vector3(0.22, 0.25, 1) : new THREE.Vector3(0.75, 0.45, 1);
    direction.normalize();
    // Near enough that every corner of what moves is just seen.
    const right = new THREE.Vector3(0, 1, 0).cross(direction).normalize();
    const up = direction.clone().cross(right);
    const tall = Math.tan((0.5 * camera.fov * Math.PI) / 180);
    let distance = 1e-6;
    for (let c = 0; c < 8; ++c) {
      const corner = new THREE.Vector3((c & 1 ? 0.5 : -0.5) * size.x, (c & 2 ? 0.5 : -0.5) * size.y, (c & 4 ? 0.5 : -0.5) * size.z);
      const sideways = Math.max(Math.abs(corner.dot(up)) / tall, Math.abs(corner.dot(right)) / (tall * camera.aspect));
      distance = Math.max(distance, corner.dot(direction) + 1.03 * sideways);
    }
    camera.position.copy(centre).addScaledVector(direction, distance);
    camera.near = distance / 200;
    camera.far = 20 * distance;
    camera.updateProjectionMatrix();
    controls.target.copy(centre);
    controls.update();
  }

  function choose(index) {
    const view = views[index];
    scene = lit();
    const box = extent(view);
    const size = box.getSize(new THREE.Vector3()).length() || 1;
    current = { view, box, range: [0, 1, ""] };
    current.bodies = buildBodies(view);
    current.lines = buildLines(view, size);
    current.surfaces = buildSurfaces(view);
    current.joints = buildJoints(view, size);
    const centre = box.getCenter(new THREE.Vector3());
    const grid = new THREE.GridHelper(1.6 * size, 16, 0xc9ced6, 0xe3e6ea);
    grid.position.set(centre.x, box.min.y - 0.04 * size, centre.z);
    const axes = new THREE.AxesHelper(0.12 * size);
    axes.position.set(centre.x - 0.78 * size, grid.position.y + 0.002 * size, centre.z + 0.78 * size);
    scene.add(grid, axes);
    const names = colourNames();
    $("colour").innerHTML = names.map((name) => "<option>" + name + "</option>").join("");
    const usual = ["potential", "stretch", "displacement"].filter((name) => names.indexOf(name) >= 0);
    if (usual.length) $("colour").value = usual[0];
    $("colouring").style.display = names.length ? "" : "none";
    $("mesh-choice").style.display = current.surfaces.length ? "" : "none";
    $("slider").max = view.frames.length - 1;
    recolour();
    resize();
    resetCamera();
    clock = 0;
    show(0);
  }

  function resize() {
    const width = holder.clientWidth, height = Math.round(Math.min(0.56 * width, 560));
    renderer.setSize(width, height);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    if (current) renderer.render(scene, camera);
  }

  /* --- playing ------------------------------------------------------------------------------------------------- */
  function play(on) {
    playing = on;
    last = 0;
    $("play").textContent = on ? "\u275a\u275a Pause" : "\u25b6 Play";
    if (on) requestAnimationFrame(tick);
  }
  function tick(now) {
    if (!playing) return;
    // The whole takes ten seconds at speed 1.
    if (last) clock += ((now - last) / 10000) * Number($("speed").value);
    last = now;
    if (clock > 1.06) clock = 0;
    show(Math.round(Math.min(clock, 1) * (current.view.frames.length - 1)));
    requestAnimationFrame(tick);
  }

  $("play").addEventListener("click", () => play(!playing));
  $("slider").addEventListener("input", () => {
    play(false);
    clock = Number($("slider").value) / Math.max(1, current.view.frames.length - 1);
    show(Number($("slider").value));
  });
  $("colour").addEventListener("change", () => { recolour(); show(frame); });
  $("mesh").addEventListener("change", () => { current.surfaces.forEach((each) => { each.grid.visible = $("mesh").checked; }); show(frame); });
  $("reset").addEventListener("click", () => { resetCamera(); show(frame); });
  $("series").innerHTML = views.map((view, i) => '<option value="' + i + '">' + view.name + "</option>").join("");
  $("series-choice").style.display = views.length > 1 ? "" : "none";
  $("series").addEventListener("change", () => choose(Number($("series").value)));
  controls.addEventListener("change", () => renderer.render(scene, camera));
  window.addEventListener("resize", resize);
  choose(0);
  // A page may be opened at a frame: report.html#frame=120
  const asked = /frame=(\d+)/.exec(window.location.hash);
  if (asked) { show(Number(asked[1])); clock = frame / Math.max(1, current.view.frames.length - 1); }
  document.body.dataset.view = "ready";
  document.body.dataset.frames = current.view.frames.length;
})();
