// The scene of a run: both bodies and their contact surfaces at each snapshot, to turn, to zoom into and to read values
// from. It stands in for the still picture of a figure, which stays where the browser has no WebGL and on paper.
(() => {
  'use strict';

  const { MAPS, decoded, place, largestDeformation, mapTexture, Part } = sceneParts;
  const { GROUPS, number, parts, element, choice, tick, slider, colourBar, Overlay } = sceneControls;
  const FACTORS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
  const STEP_MS = 160; // between two snapshots when playing
  const FIELD_OF_VIEW = 28;

  // Which of the factors draws the largest deformation as about 5 % of what is seen, 4 to 9 %.
  function startFactor(largest, seen) {
    return Math.max(FACTORS.findLastIndex(factor => factor * largest <= 0.09 * seen), 0);
  }

  class Scene {
    constructor(figure, data, context) {
      Object.assign(this, { figure, data, largest: largestDeformation(data) });
      this.fieldsOf = group => data.fields.filter(field => field.group === group);
      this.chosen = { frame: data.frames.length - 1, disk: 'cut', cutBar: true, arrows: true,
        bodies: this.fieldsOf('bodies')[0]?.name ?? 'none', contact: this.fieldsOf('contact')[0]?.name ?? 'none' };
      this.addStage(context);
      this.addBodies();
      this.addControls();
      this.setView('contact');
      this.setFrame(this.chosen.frame);
      this.addPicking();
      this.draw();
      new ResizeObserver(() => { this.fit(); this.draw(); }).observe(this.stage);
    }

    addStage(context) {
      const canvas = context.canvas;
      canvas.tabIndex = 0;
      canvas.setAttribute('role', 'img');
      canvas.setAttribute('aria-label', `${this.data.title}: both bodies in three dimensions. Arrow keys move the `
        + 'view, with Shift they turn it; plus and minus zoom.');
      this.value = element('div', { className: 'value', hidden: true });
      this.stage = element('div', { className: 'stage' }, canvas, this.value);
      this.figure.prepend(this.stage);
      this.overlay = new Overlay(this.stage);
      this.renderer = new THREE.WebGLRenderer({ canvas, context, antialias: true, alpha: true, stencil: true });
      this.renderer.localClippingEnabled = true;
      this.camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW);
      this.camera.up.set(0, 0, 1);
      this.scene = new THREE.Scene();
      const lamp = new THREE.DirectionalLight('#ffffff', 1.4);
      lamp.position.set(-0.4, 0.8, 1);
      this.camera.add(lamp);
      this.scene.add(this.camera, new THREE.AmbientLight('#ffffff', 1.9));
      this.orbit = new THREE.OrbitControls(this.camera, canvas);
      this.orbit.zoomToCursor = true;
      this.orbit.addEventListener('change', () => this.request());
      this.orbit.listenToKeyEvents(canvas);
      canvas.addEventListener('keydown', event => this.zoomByKey(event));
      // the wheel scrolls the page until the scene is in use
      this.orbit.enableZoom = false;
      canvas.addEventListener('pointerdown', () => { this.orbit.enableZoom = true; });
      canvas.addEventListener('pointerleave', () => { this.orbit.enableZoom = document.activeElement === canvas; });
      canvas.addEventListener('blur', () => { this.orbit.enableZoom = false; });
      canvas.addEventListener('webglcontextlost', () => this.figure.classList.remove('live'));
      canvas.addEventListener('webglcontextrestored', () => { this.figure.classList.add('live'); this.request(); });
    }

    zoomByKey({ key }) {
      const by = { '+': 0.8, '=': 0.8, '-': 1.25 }[key];
      if (!by) return;
      this.camera.position.sub(this.orbit.target).multiplyScalar(by).add(this.orbit.target);
      this.orbit.update();
    }

    addBodies() {
      const textures = { bodies: mapTexture(MAPS.bodies), contact: mapTexture(MAPS.contact) };
      this.plane = new THREE.Plane(new THREE.Vector3(0, 1, 0), 1e-9);
      this.bodies = {};
      this.parts = this.data.meshes.map(mesh => {
        const part = new Part(mesh, textures[mesh.group], this.data.span / 36);
        this.bodies[mesh.name] ??= new THREE.Group();
        this.bodies[mesh.name].add(part.object);
        const modelled = mesh.points.every((value, at) => at % 3 !== 1 || value > -1e-6);
        if (this.data.half && modelled) this.bodies[mesh.name].add(this.mirror(part));
        else if (mesh.group === 'bodies') part.addCap(this.plane, 1000 * this.data.span);
        return part;
      });
      this.scene.add(...Object.values(this.bodies));
    }

    // The other half, of the same arrays.
    mirror(part) {
      part.mirrored = part.object.clone();
      part.mirrored.children.forEach(child => { child.part = part; });
      part.mirrored.scale.y = -1;
      return part.mirrored;
    }

    addControls() {
      const { chosen, data } = this;
      this.own = {}; // what the reader has chosen, which a change of the view leaves as it is
      const set = (key, value) => { chosen[key] = value; this.own[key] = true; this.refresh(); };
      const button = (text, onclick) => element('button', { type: 'button', textContent: text, onclick });
      this.views = {
        contact: button('Contact', () => this.setView('contact')),
        whole: button('Whole', () => this.setView('whole')),
      };
      this.play = button('Play', () => this.setPlaying(!this.timer));
      this.time = slider('time', 'Time', data.frames.length - 1, frame => this.setFrame(frame));
      this.factor = slider('factor', 'Deformation', FACTORS.length - 1, at => {
        this.own.factor = true;
        this.setFactor(at);
      });
      this.mesh = tick('mesh', shown => set('mesh', shown));
      this.cutBar = tick('cut bar', cut => set('cutBar', cut));
      const arrows = tick('shear arrows', shown => set('arrows', shown));
      this.cutBar.box.checked = arrows.box.checked = true;
      const fields = group => {
        const names = Object.fromEntries(this.fieldsOf(group).map(({ name, label }) => [name, parts(label).name]));
        return choice(GROUPS[group], { ...names, none: 'none' }, chosen[group], name => set(group, name));
      };
      const disks = { cut: 'cut at y = 0', lifted: 'cut, lifted', whole: 'whole', hidden: 'hidden' };
      this.disk = choice('Disk', disks, chosen.disk, value => set('disk', value));
      this.bars = element('div', { className: 'bars' });
      const views = element('span', { role: 'group', ariaLabel: 'View' }, 'View ', ...Object.values(this.views));
      const controls = element('div', { className: 'controls' }, views,
        element('span', { className: 'times' }, this.play, this.time), fields('bodies'), fields('contact'), this.factor,
        this.disk, this.cutBar, this.mesh);
      if (data.frames.some(({ meshes }) => meshes.some(state => state.shear_vector))) controls.append(arrows);
      const hint = 'Drag to turn; drag with the right button or two fingers to move; after a click the wheel zooms.';
      const note = element('p', { className: 'note', textContent: [data.note, hint].filter(Boolean).join(' ') });
      this.stage.after(this.bars, controls, note);
    }

    setPlaying(on) {
      clearInterval(this.timer);
      const next = () => this.setFrame((this.chosen.frame + 1) % this.data.frames.length);
      this.timer = on ? setInterval(next, STEP_MS) : undefined;
      this.play.textContent = on ? 'Pause' : 'Play';
    }

    setFrame(frame) {
      const moved = this.centre(frame).sub(this.centre(this.chosen.frame));
      if (this.view === 'contact') {
        this.camera.position.add(moved);
        this.orbit.target.add(moved);
      }
      this.chosen.frame = frame;
      this.time.range.value = frame;
      this.time.lastChild.textContent = `${(1000 * this.data.frames[frame].time).toFixed(3)} ms`;
      this.unpick();
      this.refresh();
    }

    setFactor(at) {
      this.chosen.factor = FACTORS[at];
      this.factor.range.value = at;
      this.factor.lastChild.textContent = `\u00d7 ${FACTORS[at]}`;
      this.refresh();
    }

    centre(frame) {
      return new THREE.Vector3(...this.data.frames[frame].centre);
    }

    // What both bodies take up from first to last: its middle, and the length of its diagonal.
    extent() {
      const [low, high] = [Infinity, -Infinity].map(far => new THREE.Vector3(far, far, far));
      for (const frame of [this.data.frames[0], this.data.frames.at(-1)]) {
        this.parts.forEach((part, k) => {
          for (let node = 0; 3 * node < part.points.length; node++) {
            const at = new THREE.Vector3(...place(part.points, frame.meshes[k], 1, node));
            low.min(at);
            high.max(at);
          }
        });
      }
      if (this.data.half) low.y = Math.min(low.y, -high.y);
      return { middle: low.clone().add(high).multiplyScalar(0.5), size: high.distanceTo(low) };
    }

    setView(view) {
      this.view = view;
      for (const name in this.views) this.views[name].ariaPressed = String(name === view);
      const near = view === 'contact';
      const { middle, size } = near ? { middle: this.centre(this.chosen.frame), size: this.data.span } : this.extent();
      this.seen = size;
      this.setDefaults(near);
      this.fit();
      // the span is as wide as the picture; of the diagonal of both bodies little more than their height is seen
      const high = near ? size / this.camera.aspect : 0.77 * size / Math.min(this.camera.aspect, 1);
      const from = near ? new THREE.Vector3(-0.34, -1, 0.46) : new THREE.Vector3(-0.55, -1, 0.3);
      this.orbit.target.copy(middle);
      this.camera.position.copy(from.setLength(high / (2 * Math.tan(FIELD_OF_VIEW * Math.PI / 360)))).add(middle);
      this.orbit.update();
      this.refresh();
    }

    // What suits a view, where the reader has not chosen.
    setDefaults(near) {
      const { own, chosen } = this;
      if (!own.factor) this.setFactor(startFactor(this.largest, near ? this.seen : this.seen / 1.5));
      if (!own.mesh) chosen.mesh = this.mesh.box.checked = near;
      if (!own.cutBar) chosen.cutBar = this.cutBar.box.checked = near;
      if (!own.disk) chosen.disk = this.disk.lastChild.value = near ? 'cut' : 'whole';
    }

    // Brings what is drawn up to what is chosen.
    refresh() {
      const { chosen, data } = this;
      const frame = data.frames[chosen.frame];
      const field = group => data.fields.find(known => known.name === chosen[group]);
      const top = name => data.fields.find(known => known.name === name)?.top;
      this.parts.forEach((part, k) => {
        const cut = part.name === 'disk' ? ['cut', 'lifted'].includes(chosen.disk) : chosen.cutBar;
        part.show(frame.meshes[k], chosen.factor, field(part.group), top('pressure'));
        if (part.arrows) part.arrows.visible = chosen.arrows;
        if (part.arrows && chosen.arrows) part.showArrows(frame.meshes[k], top('shear'));
        for (const { children: [surface, lines] } of [part.object, part.mirrored].filter(Boolean)) {
          surface.visible = part.surface.visible;
          lines.visible = Boolean(chosen.mesh) && surface.visible;
        }
        if (part.mirrored) part.mirrored.visible = !cut;
        // the bar's contact surface is whole at any rate: it is what the scene is about
        const clipped = cut && !part.mirrored && !(part.group === 'contact' && part.name === 'bar');
        part.object.children.filter(child => child !== part.cap)
          .forEach(({ material }) => { material.clippingPlanes = clipped ? [this.plane] : null; });
        if (part.cap) part.cap.visible = clipped;
        if (part.outline) part.close(part.mirrored?.visible);
      });
      const { disk } = this.bodies;
      if (disk) {
        disk.visible = chosen.disk !== 'hidden';
        disk.position.z = chosen.disk === 'lifted' ? 0.3 * this.seen : 0;
      }
      const bar = group => colourBar(group, field(group), MAPS[group]);
      this.bars.replaceChildren(...Object.keys(GROUPS).filter(field).map(bar));
      this.request();
    }

    fit() {
      this.size = { width: this.stage.clientWidth, height: this.stage.clientHeight };
      this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
      this.renderer.setSize(this.size.width, this.size.height, false);
      this.camera.aspect = this.size.width / this.size.height;
    }

    // Draws once before the next frame of the browser; nothing is drawn while nothing changes.
    request() {
      this.requested ??= requestAnimationFrame(() => this.draw());
    }

    draw() {
      cancelAnimationFrame(this.requested);
      this.requested = undefined;
      const distance = this.camera.position.distanceTo(this.orbit.target);
      Object.assign(this.camera, { near: 0.02 * distance, far: distance + 10 * this.seen + 5 });
      this.camera.updateProjectionMatrix();
      this.renderer.render(this.scene, this.camera);
      this.overlay.draw(this.camera, this.orbit.target, this.size, this.picked);
      this.figure.dataset.drawn = 'true';
      this.figure.dispatchEvent(new Event('drawn'));
    }

    // ---- Picking ----

    addPicking() {
      const canvas = this.renderer.domElement;
      const pick = event => {
        cancelAnimationFrame(this.picking);
        this.picking = requestAnimationFrame(() => this.pick(event));
      };
      canvas.addEventListener('pointermove', event => { if (event.buttons === 0) pick(event); });
      canvas.addEventListener('click', pick);
      canvas.addEventListener('pointerleave', () => { cancelAnimationFrame(this.picking); this.unpick(); });
      this.orbit.addEventListener('start', () => this.unpick());
    }

    unpick() {
      if (!this.picked) return;
      this.picked = null;
      this.value.hidden = true;
      this.request();
    }

    // The surface under the pointer; of the body's and the contact surface on it the latter.
    hit({ clientX, clientY }) {
      const box = this.stage.getBoundingClientRect();
      const at = new THREE.Vector2(2 * (clientX - box.left) / box.width - 1, 1 - 2 * (clientY - box.top) / box.height);
      const ray = new THREE.Raycaster();
      ray.setFromCamera(at, this.camera);
      const shown = object => object === null || (object.visible && shown(object.parent));
      const surfaces = [];
      this.scene.traverse(object => {
        if (object.part?.surface.material === object.material && shown(object)) surfaces.push(object);
      });
      const hits = ray.intersectObjects(surfaces, false)
        .filter(({ object, point }) => !object.material.clippingPlanes || this.plane.distanceToPoint(point) >= 0)
        .filter(({ uv }) => uv.y >= 0.5); // where a contact surface has an end
      const near = hits.filter(({ distance }) => distance < hits[0].distance * 1.003);
      return near.find(({ object }) => object.part.group === 'contact') ?? hits[0];
    }

    pick(event) {
      const hit = this.hit(event);
      if (!hit) return this.unpick();
      const { part } = hit.object;
      const positions = part.geometry.attributes.position;
      const drawn = node => hit.object.localToWorld(new THREE.Vector3().fromBufferAttribute(positions, node));
      const { a, b, c } = hit.face;
      const far = node => drawn(node).distanceTo(hit.point);
      const node = [a, b, c].sort((one, other) => far(one) - far(other))[0];
      this.picked = drawn(node);
      this.describe(part, node, hit.object.parent === part.mirrored, event);
      this.request();
    }

    describe(part, node, mirrored, event) {
      const state = this.data.frames[this.chosen.frame].meshes[this.parts.indexOf(part)];
      const row = (text, strong) => element(strong ? 'b' : 'div', { textContent: text });
      const rows = this.fieldsOf(part.group).filter(({ name }) => state.values[name]).map(({ name, label }) => {
        const { name: text, unit } = parts(label);
        return row(`${text} ${number(state.values[name][node])}${unit}`, name === this.chosen[part.group]);
      });
      const [x, y, z] = place(part.points, state, 1, node);
      const millimetres = value => number(Number((1000 * value).toFixed(3)), 6);
      const where = [x, mirrored ? -y : y, z].map((value, k) => `${'xyz'[k]} ${millimetres(value)}`).join(', ');
      const title = part.group === 'contact' ? `${part.name}, contact surface` : part.name;
      this.value.replaceChildren(row(title), ...rows, row(`${where} mm`));
      this.showBeside(event);
    }

    showBeside({ clientX, clientY }) {
      this.value.hidden = false;
      const box = this.stage.getBoundingClientRect();
      const [width, height] = [this.value.offsetWidth, this.value.offsetHeight];
      const [x, y] = [clientX - box.left, clientY - box.top];
      const left = x + 14 + width > box.width ? x - 14 - width : x + 14;
      this.value.style.left = `${Math.max(left, 0)}px`;
      this.value.style.top = `${Math.max(Math.min(y + 14, box.height - height - 4), 0)}px`;
    }
  }

  function build(figure) {
    // asked for here, since three.js would write an error to the console where there is none
    const wanted = { antialias: true, alpha: true, stencil: true };
    const context = document.createElement('canvas').getContext('webgl2', wanted);
    if (!context) return;
    figure.classList.add('live');
    try {
      new Scene(figure, decoded(JSON.parse(figure.querySelector('.scene-data').textContent)), context);
    } catch (error) {
      figure.classList.remove('live');
      throw error;
    }
  }

  addEventListener('load', () => document.querySelectorAll('figure.scene').forEach(build));
})();
