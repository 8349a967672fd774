// The scene of a run: both bodies and their contact surfaces at each snapshot, to turn, to zoom into and to read values
// from. It stands in for the still picture of a figure, which stays where the browser has no WebGL and on paper.
(() => {
  'use strict';

  const FACTORS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
  const STEP_MS = 160; // between two snapshots when playing
  const FIELD_OF_VIEW = 28;
  // Two sequential maps with an even course of lightness: of the bodies light to dark, so that what carries little load
  // looks plain; of the contact surfaces dark to light (inferno), so that a patch stands out from them.
  const MAPS = {
    bodies: '#dbe5e9 #b8dae6 #8fc4de #6aadd6 #4c95cd #377bc0 #2c61b0 #29479b #262e83 #221667',
    contact: '#000004 #0c0826 #240c4f #420a68 #5d126e #781c6d #932667 #ae305c #c73e4c #dd513a #ed6925 #f8850f #fca50a '
      + '#fac62d #f2e661 #fcffa4',
  };
  const GROUPS = { bodies: 'Bodies', contact: 'Contact surfaces' };
  const UP = { disk: -1, bar: 1 }; // of a contact surface, along z

  // ---- Data --------------------------------------------------------------------------------------------------------

  function decode(text, Kind) {
    const bytes = Uint8Array.fromBase64?.(text) ?? Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
    return new Kind(bytes.buffer, bytes.byteOffset, bytes.byteLength / Kind.BYTES_PER_ELEMENT);
  }

  // The data with its arrays decoded, in place.
  function decoded(data) {
    for (const mesh of data.meshes) {
      mesh.points = decode(mesh.points, Float32Array);
      mesh.quads = decode(mesh.quads, Uint32Array);
    }
    for (const state of data.frames.flatMap(frame => frame.meshes)) {
      state.deformation = decode(state.deformation, Float32Array);
      if (state.shear_vector) state.shear_vector = decode(state.shear_vector, Float32Array);
      for (const name in state.values) state.values[name] = decode(state.values[name], Float32Array);
    }
    return data;
  }

  // Where a node is drawn: the rigid motion of its body, and its deformation so many times as large.
  function place(points, { rigid: r, deformation: d }, factor, node) {
    const [x, y, z] = [points[3 * node], points[3 * node + 1], points[3 * node + 2]];
    return [0, 1, 2].map(k =>
      r[4 * k] * x + r[4 * k + 1] * y + r[4 * k + 2] * z + r[4 * k + 3] + factor * d[3 * node + k]);
  }

  function largestDeformation(data) {
    let most = 0;
    for (const { deformation: d } of data.frames.flatMap(frame => frame.meshes)) {
      for (let at = 0; at < d.length; at += 3) most = Math.max(most, d[at] ** 2 + d[at + 1] ** 2 + d[at + 2] ** 2);
    }
    return Math.sqrt(most);
  }

  // The largest of the factors that draws the largest deformation as no more than 5 % of what is seen.
  function startFactor(largest, seen) {
    return Math.max(FACTORS.findLastIndex(factor => factor * largest <= 0.05 * seen), 0);
  }

  // Nodes no closer than `size`, one for each cube of that size that has any.
  function thinned(points, size) {
    const cubes = new Map();
    for (let node = 0; 3 * node < points.length; node++) {
      const key = [0, 1, 2].map(k => Math.round(points[3 * node + k] / size)).join();
      if (!cubes.has(key)) cubes.set(key, node);
    }
    return [...cubes.values()];
  }

  function meanEdge({ points, quads }) {
    const far = (a, b) => Math.hypot(...[0, 1, 2].map(k => points[3 * a + k] - points[3 * b + k]));
    let sum = 0;
    for (let at = 0; at < quads.length; at += 4) sum += far(quads[at], quads[at + 1]);
    return sum / Math.max(quads.length / 4, 1);
  }

  // Pairs of nodes of edges at which a surface turns by more than 30 degrees or ends; in the plane y = 0, where a half model
  // is cut, after all others.
  function creases({ points, quads }) {
    const at = node => new THREE.Vector3().fromArray(points, 3 * node);
    const edges = new Map();
    for (let k = 0; k < quads.length; k += 4) {
      const [a, b, c, d] = quads.subarray(k, k + 4);
      const normal = at(c).sub(at(a)).cross(at(d).sub(at(b))).normalize();
      for (const [i, j] of [[a, b], [b, c], [c, d], [d, a]]) {
        const key = Math.min(i, j) * points.length + Math.max(i, j);
        const known = edges.get(key);
        if (known) known.sharp = known.normal.dot(normal) < 0.866;
        else edges.set(key, { nodes: [i, j], normal, sharp: true });
      }
    }
    const sharp = [...edges.values()].filter(edge => edge.sharp).map(edge => edge.nodes);
    const cut = nodes => nodes.every(node => Math.abs(points[3 * node + 1]) < 1e-6);
    const outside = sharp.filter(nodes => !cut(nodes));
    return { outside: 2 * outside.length, nodes: outside.concat(sharp.filter(cut)).flat() };
  }

  function number(value, significant = 4) {
    return String(Number(value.toPrecision(significant))).replace('-', '\u2212');
  }

  function parts(label) {
    const [, name, unit] = label.match(/^(.*?)(?:\s*\(([^()]*)\))?$/);
    return { name, unit: unit ? ` ${unit}` : '' };
  }

  // ---- What is drawn -----------------------------------------------------------------------------------------------

  // The colours of a map along u; across, from nothing (v = 1/4) to opaque (v = 3/4).
  function mapTexture(stops) {
    const colours = stops.split(' ').map(stop => [1, 3, 5].map(at => parseInt(stop.slice(at, at + 2), 16)));
    const texels = new Uint8Array(2 * 4 * 256);
    for (let k = 0; k < 512; k++) {
      const at = k % 256 / 255 * (colours.length - 1);
      const low = Math.min(Math.floor(at), colours.length - 2);
      const mixed = colours[low].map((value, c) => value + (at - low) * (colours[low + 1][c] - value));
      texels.set([...mixed, k < 256 ? 0 : 255], 4 * k);
    }
    const texture = new THREE.DataTexture(texels, 256, 2);
    texture.colorSpace = THREE.SRGBColorSpace;
    texture.minFilter = texture.magFilter = THREE.LinearFilter;
    texture.needsUpdate = true;
    return texture;
  }

  const buffer = (array, size) => new THREE.BufferAttribute(array, size).setUsage(THREE.DynamicDrawUsage);

  // A surface of the data. Its colours are places on the map of its group, which are found per pixel: colours of nodes,
  // if mixed between them, would not be those of the map.
  class Part {
    constructor(mesh, texture, spacing) {
      Object.assign(this, mesh, { object: new THREE.Group() });
      const count = mesh.points.length / 3;
      this.geometry = new THREE.BufferGeometry();
      this.geometry.setAttribute('position', buffer(new Float32Array(3 * count), 3));
      this.geometry.setAttribute('uv', buffer(new Float32Array(2 * count).fill(0.75), 2));
      this.geometry.setIndex(buffer(new Uint32Array(1.5 * mesh.quads.length), 1));
      this.edges = new THREE.BufferGeometry();
      this.edges.setAttribute('position', this.geometry.attributes.position);
      this.edges.setIndex(buffer(new Uint32Array(2 * mesh.quads.length), 1));
      this.drawQuads(null);
      const contact = mesh.group === 'contact';
      // contact surfaces lie on the bodies' own and are drawn in front of them, without shades that alter colours
      const offset = { polygonOffset: true, polygonOffsetFactor: contact ? -1 : 1, polygonOffsetUnits: contact ? -2 : 1 };
      this.surface = new THREE.Mesh(this.geometry, contact
        ? new THREE.MeshBasicMaterial({ map: texture, alphaTest: 0.5, ...offset })
        : new THREE.MeshLambertMaterial({ map: texture, flatShading: true, ...offset }));
      this.lines = new THREE.LineSegments(this.edges, new THREE.LineBasicMaterial(
        { color: contact ? '#ffffff' : '#10202c', transparent: true, opacity: contact ? 0.16 : 0.22 }));
      this.object.add(this.surface, this.lines);
      if (contact) this.addArrows(spacing);
      else {
        this.addInside();
        this.addOutline();
      }
      for (const child of this.object.children) Object.assign(child, { frustumCulled: false, part: this });
    }

    addOutline() {
      const { nodes, outside } = creases(this);
      const edges = new THREE.BufferGeometry().setIndex(nodes);
      edges.setAttribute('position', this.geometry.attributes.position);
      this.outline = new THREE.LineSegments(edges, new THREE.LineBasicMaterial({ color: '#33424d' }));
      this.outline.count = { outside, all: nodes.length };
      this.object.add(this.outline);
    }

    // Bodies are known by their surfaces. The inside that a cut lays bare has one colour, without shades: it looks filled.
    addInside() {
      this.inside = new THREE.Mesh(this.geometry, new THREE.MeshBasicMaterial(
        { color: '#b9bfc4', side: THREE.BackSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }));
      this.object.add(this.inside);
    }

    addArrows(spacing) {
      this.arrowLength = Math.max(meanEdge(this), spacing);
      this.arrowNodes = thinned(this.points, this.arrowLength);
      const flat = [0, -0.07, 0, 0.6, -0.07, 0, 0.6, 0.07, 0, 0, -0.07, 0, 0.6, 0.07, 0, 0, 0.07, 0,
        0.55, -0.24, 0, 1, 0, 0, 0.55, 0.24, 0];
      const shape = new THREE.BufferGeometry();
      shape.setAttribute('position', new THREE.BufferAttribute(new Float32Array(flat), 3));
      this.arrows = new THREE.InstancedMesh(shape, new THREE.MeshBasicMaterial(
        { color: '#0a0a0a', side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: -3, polygonOffsetUnits: -40 }),
      this.arrowNodes.length);
      this.object.add(this.arrows);
    }

    // Draws the quads that have a node with a pressure, and the edges of those with no other; all where none is given.
    drawQuads(pressure) {
      const [triangles, edges] = [this.geometry.index, this.edges.index];
      let [t, e] = [0, 0];
      for (let at = 0; at < this.quads.length; at += 4) {
        const [a, b, c, d] = this.quads.subarray(at, at + 4);
        const pressed = pressure ? [a, b, c, d].filter(node => pressure[node] > 0).length : 4;
        if (pressed === 0) continue;
        triangles.array.set([a, b, c, a, c, d], t);
        t += 6;
        if (pressed < 4) continue;
        edges.array.set([a, b, b, c, c, d, d, a], e);
        e += 8;
      }
      this.geometry.setDrawRange(0, t);
      this.edges.setDrawRange(0, e);
      triangles.needsUpdate = edges.needsUpdate = true;
    }

    // A contact surface ends where 1 % of the largest pressure is left.
    show(state, factor, field, largestPressure) {
      const { position, uv } = this.geometry.attributes;
      const { [field?.name]: values, pressure } = state.values;
      for (let node = 0; node < position.count; node++) {
        position.array.set(place(this.points, state, factor, node), 3 * node);
        uv.array[2 * node] = values && field.top > 0 ? Math.min(Math.max(values[node] / field.top, 0), 1) : 0;
        if (pressure && largestPressure) uv.array[2 * node + 1] = 0.25 + Math.min(25 * pressure[node] / largestPressure, 0.5);
      }
      position.needsUpdate = uv.needsUpdate = true;
      this.geometry.boundingSphere = null; // the one that picking would make use of
      if (this.group === 'contact') this.drawQuads(pressure);
      this.surface.visible = this.group === 'bodies' || Boolean(values);
    }

    showArrows({ shear_vector: shear }, top) {
      const position = this.geometry.attributes.position;
      const up = new THREE.Vector3(0, 0, UP[this.name] ?? 1);
      const [along, side, at, matrix] = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3(), new THREE.Matrix4()];
      let count = 0;
      for (const node of shear && top > 0 ? this.arrowNodes : []) {
        along.fromArray(shear, 3 * node).multiplyScalar(1.25 * this.arrowLength / top);
        const length = along.length();
        if (length < 0.06 * this.arrowLength) continue;
        // the middle of an arrow is at its node
        at.fromBufferAttribute(position, node).addScaledVector(along, -0.5).addScaledVector(up, 0.03 * this.arrowLength);
        side.crossVectors(up, along);
        matrix.makeBasis(along, side, up).setPosition(at);
        this.arrows.setMatrixAt(count++, matrix);
      }
      this.arrows.count = count;
      this.arrows.instanceMatrix.needsUpdate = true;
    }
  }

  // ---- Controls ----------------------------------------------------------------------------------------------------

  function element(name, properties = {}, ...children) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  }

  const labelled = (text, ...controls) => element('label', {}, element('span', { textContent: text }), ...controls);

  function choice(text, options, value, change) {
    const select = element('select', { onchange: () => change(select.value) });
    select.append(...Object.entries(options).map(([key, shown]) => element('option', { value: key, textContent: shown })));
    select.value = value;
    return labelled(text, select);
  }

  function tick(text, change) {
    const box = element('input', { type: 'checkbox', onchange: () => change(box.checked) });
    return Object.assign(element('label', { className: 'tick' }, box, text), { box });
  }

  function slider(name, text, last, change) {
    const range = element('input', { type: 'range', min: 0, max: last, step: 1, value: 0, className: name });
    range.oninput = () => change(Number(range.value));
    return Object.assign(labelled(text, range, element('output')), { range });
  }

  // The steps of a scale from zero: about `count`, round numbers.
  function roundStep(top, count) {
    const rough = top / count;
    const power = 10 ** Math.floor(Math.log10(rough));
    return power * [1, 2, 5, 10].find(step => step * power >= rough * 0.999);
  }

  function colourBar(group, field) {
    const bar = element('div', { className: 'bar' }, element('div', { textContent: `${GROUPS[group]}: ${field.label}` }));
    const strip = bar.appendChild(element('div', { className: 'strip' }));
    strip.style.background = `linear-gradient(to right,${MAPS[group].split(' ').join()})`;
    const step = roundStep(field.top, 5);
    for (let k = 0; k * step <= field.top * 1.001; k++) {
      const mark = strip.appendChild(element('span', { textContent: number(k * step) }));
      mark.style.left = `${100 * k * step / field.top}%`;
    }
    return bar;
  }

  // Lines and a text over the picture: where the axes point, and a length at the middle of the view.
  class Overlay {
    constructor(stage) {
      const made = (name, parent, attributes) => {
        const shape = document.createElementNS('http://www.w3.org/2000/svg', name);
        Object.entries(attributes).forEach(([key, value]) => shape.setAttribute(key, value));
        return parent.appendChild(shape);
      };
      this.svg = made('svg', stage, { class: 'over', 'aria-hidden': 'true' });
      this.axes = ['x', 'y', 'z'].map(name => {
        const [line, text] = [made('line', this.svg, {}), made('text', this.svg, {})];
        text.textContent = name === 'x' ? 'x, rolling' : name;
        return { line, text };
      });
      this.length = made('path', this.svg, {});
      this.lengthText = made('text', this.svg, {});
      this.dot = made('circle', this.svg, { r: 4, class: 'dot' });
    }

    draw(camera, target, { width, height }, point) {
      this.axes.forEach(({ line, text }, k) => {
        const to = new THREE.Vector3().setComponent(k, 30).applyQuaternion(camera.quaternion.clone().invert());
        const [x, y] = [48, height - 44];
        const ends = { x1: x, y1: y, x2: x + to.x, y2: y - to.y };
        Object.entries(ends).forEach(([key, value]) => line.setAttribute(key, value));
        text.setAttribute('x', x + 1.25 * to.x - 3);
        text.setAttribute('y', y - 1.25 * to.y + 4);
      });
      const pixels = height / (2 * camera.position.distanceTo(target) * Math.tan(FIELD_OF_VIEW * Math.PI / 360));
      const length = roundStep(width / pixels, 7);
      const [right, base] = [width - 16, height - 16];
      this.length.setAttribute('d', `M${right - length * pixels} ${base - 6}v6H${right}v-6`);
      this.lengthText.textContent = `${number(1000 * length)} mm`;
      this.lengthText.setAttribute('x', right - 4 - this.lengthText.getComputedTextLength());
      this.lengthText.setAttribute('y', base - 6);
      const on = point?.clone().project(camera);
      this.dot.setAttribute('cx', on ? (on.x + 1) / 2 * width : -9);
      this.dot.setAttribute('cy', on ? (1 - on.y) / 2 * height : -9);
    }
  }

  // ---- The scene of a figure ---------------------------------------------------------------------------------------

  class Scene {
    constructor(figure, data, context) {
      Object.assign(this, { figure, data, largest: largestDeformation(data) });
      this.fieldsOf = group => data.fields.filter(field => field.group === group);
      this.chosen = { frame: data.frames.length - 1, disk: 'cut', cutBar: true, arrows: true,
        bodies: this.fieldsOf('bodies')[0]?.name, contact: this.fieldsOf('contact')[0]?.name };
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
      canvas.setAttribute('aria-label', `${this.data.title}: both bodies in three dimensions. Arrow keys move the view, `
        + 'with Shift they turn it; plus and minus zoom.');
      this.value = element('div', { className: 'value', hidden: true });
      this.stage = element('div', { className: 'stage' }, canvas, this.value);
      this.figure.prepend(this.stage);
      this.overlay = new Overlay(this.stage);
      this.renderer = new THREE.WebGLRenderer({ canvas, context, antialias: true, alpha: true });
      this.renderer.localClippingEnabled = true;
      this.camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW);
      this.camera.up.set(0, 0, 1);
      this.scene = new THREE.Scene();
      const lamp = new THREE.DirectionalLight('#ffffff', 2);
      lamp.position.set(-0.4, 0.8, 1);
      this.camera.add(lamp);
      this.scene.add(this.camera, new THREE.AmbientLight('#ffffff', 2));
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
      this.views = { contact: button('Contact', () => this.setView('contact')), whole: button('Whole', () => this.setView('whole')) };
      this.play = button('Play', () => this.setPlaying(!this.timer));
      this.time = slider('time', 'Time', data.frames.length - 1, frame => this.setFrame(frame));
      this.factor = slider('factor', 'Deformation', FACTORS.length - 1, at => { this.own.factor = true; this.setFactor(at); });
      this.mesh = tick('mesh', shown => set('mesh', shown));
      this.cutBar = tick('cut bar', cut => set('cutBar', cut));
      const arrows = tick('shear arrows', shown => set('arrows', shown));
      this.cutBar.box.checked = arrows.box.checked = true;
      const fields = group => this.fieldsOf(group).length === 0 ? [] : [choice(GROUPS[group],
        { ...Object.fromEntries(this.fieldsOf(group).map(field => [field.name, parts(field.label).name])), none: 'none' },
        chosen[group], name => set(group, name))];
      const disks = { cut: 'cut at y = 0', whole: 'whole', lifted: 'lifted', hidden: 'hidden' };
      const has = data.frames.some(frame => frame.meshes.some(state => state.shear_vector));
      this.disk = choice('Disk', disks, chosen.disk, value => set('disk', value));
      this.bars = element('div', { className: 'bars' });
      this.stage.after(this.bars, element('div', { className: 'controls' },
        element('span', { className: 'views', role: 'group', ariaLabel: 'View' }, ...Object.values(this.views)),
        element('span', { className: 'times' }, this.play, this.time), ...fields('bodies'), ...fields('contact'), this.factor,
        this.disk, this.cutBar, this.mesh, ...(has ? [arrows] : [])));
      const hint = 'Drag to turn, with the right button to move; click, then the wheel zooms.';
      this.bars.nextSibling.after(element('p', { className: 'note', textContent: [data.note, hint].filter(Boolean).join(' ') }));
    }

    setPlaying(on) {
      clearInterval(this.timer);
      const next = () => this.setFrame((this.chosen.frame + 1) % this.data.frames.length);
      this.timer = on ? setInterval(next, STEP_MS) : undefined;
      this.play.textContent = on ? 'Pause' : 'Play';
    }

    setFrame(frame) {
      const moved = new THREE.Vector3(...this.data.frames[frame].centre)
        .sub(new THREE.Vector3(...this.data.frames[this.chosen.frame].centre));
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

    // What both bodies take up over all times: its middle and the length of its diagonal.
    extent() {
      const [low, high] = [new THREE.Vector3(Infinity, Infinity, Infinity), new THREE.Vector3(-Infinity, -Infinity, -Infinity)];
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
      const near = view === 'contact';
      const { middle, size } = near ? { middle: new THREE.Vector3(...this.data.frames[this.chosen.frame].centre), size: this.data.span }
        : this.extent();
      this.seen = size;
      for (const name in this.views) this.views[name].ariaPressed = String(name === view);
      if (!this.own.factor) this.setFactor(startFactor(this.largest, near ? size : size / 1.5));
      if (!this.own.mesh) this.chosen.mesh = this.mesh.box.checked = near;
      if (!this.own.cutBar) this.chosen.cutBar = this.cutBar.box.checked = near;
      if (!this.own.disk) this.chosen.disk = this.disk.lastChild.value = near ? 'cut' : 'whole';
      this.fit();
      const distance = size / (2 * Math.tan(FIELD_OF_VIEW * Math.PI / 360)) / (near ? this.camera.aspect : 1.3 * Math.min(this.camera.aspect, 1));
      const from = near ? new THREE.Vector3(-0.34, -1, 0.46) : new THREE.Vector3(-0.55, -1, 0.3);
      this.orbit.target.copy(middle);
      this.camera.position.copy(from.setLength(distance)).add(middle);
      this.orbit.update();
      this.refresh();
    }

    // Brings what is drawn up to what is chosen.
    refresh() {
      const { chosen, data } = this;
      const frame = data.frames[chosen.frame];
      const field = group => data.fields.find(known => known.name === chosen[group]);
      const top = name => data.fields.find(known => known.name === name)?.top;
      this.parts.forEach((part, k) => {
        const cut = part.name === 'disk' ? chosen.disk === 'cut' : chosen.cutBar;
        part.show(frame.meshes[k], chosen.factor, field(part.group), top('pressure'));
        part.lines.visible = Boolean(chosen.mesh) && part.surface.visible;
        if (part.arrows) part.arrows.visible = chosen.arrows;
        if (part.arrows && chosen.arrows) part.showArrows(frame.meshes[k], top('shear'));
        if (part.mirrored) part.mirrored.visible = !cut;
        // the bar's contact surface is whole at any rate: it is what the scene is about
        const clipped = cut && !part.mirrored && !(part.group === 'contact' && part.name === 'bar');
        part.object.children.forEach(({ material }) => { material.clippingPlanes = clipped ? [this.plane] : null; });
        if (part.inside) part.inside.visible = clipped;
        part.outline?.geometry.setDrawRange(0, part.outline.count[part.mirrored?.visible ? 'outside' : 'all']);
      });
      const { disk } = this.bodies;
      if (disk) {
        disk.visible = chosen.disk !== 'hidden';
        disk.position.z = chosen.disk === 'lifted' ? 0.3 * this.seen : 0;
      }
      this.bars.replaceChildren(...Object.keys(GROUPS).filter(field).map(group => colourBar(group, field(group))));
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
        .filter(({ object, point }) => !object.material.clippingPlanes || this.plane.distanceToPoint(point) >= 0);
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

    describe(part, node, mirrored, { clientX, clientY }) {
      const state = this.data.frames[this.chosen.frame].meshes[this.parts.indexOf(part)];
      const row = (text, strong) => element(strong ? 'b' : 'div', { textContent: text });
      const rows = this.fieldsOf(part.group).filter(({ name }) => state.values[name]).map(({ name, label }) =>
        row(`${parts(label).name} ${number(state.values[name][node])}${parts(label).unit}`, name === this.chosen[part.group]));
      const [x, y, z] = place(part.points, state, 1, node).map(value => 1000 * value);
      const where = [x, mirrored ? -y : y, z].map((value, k) => `${'xyz'[k]} ${number(Number(value.toFixed(3)), 6)}`).join(', ');
      this.value.replaceChildren(row(part.group === 'contact' ? `${part.name}, contact surface` : part.name), ...rows, row(`${where} mm`));
      this.value.hidden = false;
      const box = this.stage.getBoundingClientRect();
      const [left, top] = [clientX - box.left + 14, clientY - box.top + 14];
      this.value.style.left = `${left + this.value.offsetWidth > box.width ? Math.max(left - 28 - this.value.offsetWidth, 0) : left}px`;
      this.value.style.top = `${Math.max(Math.min(top, box.height - this.value.offsetHeight - 4), 0)}px`;
    }
  }

  function build(figure) {
    // asked for here, since three.js would write an error to the console where there is none
    const context = document.createElement('canvas').getContext('webgl2', { antialias: true, alpha: true });
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
