// What the scene of a run is made of: its data, and the surfaces that three.js draws of them. scene.js makes use of it.
const sceneParts = (() => {
  'use strict';

  // Two sequential maps with an even course of lightness: of the bodies light to dark, so that what carries little load
  // looks plain; of the contact surfaces dark to light (inferno), so that a patch stands out from them.
  const MAPS = {
    bodies: '#dbe5e9 #b8dae6 #8fc4de #6aadd6 #4c95cd #377bc0 #2c61b0 #29479b #262e83 #221667',
    contact: '#000004 #0c0826 #240c4f #420a68 #5d126e #781c6d #932667 #ae305c #c73e4c #dd513a #ed6925 #f8850f #fca50a '
      + '#fac62d #f2e661 #fcffa4',
  };
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
    join(data);
    return data;
  }

  // Has contact surfaces deform as the bodies do where they share nodes: they may be records of slightly different
  // times, and much enlarged the one would cover the other.
  function join({ meshes, frames, half }) {
    const key = (points, node) => [0, 1, 2].map(k => {
      const value = points[3 * node + k];
      return Math.round(1e7 * (half && k === 1 ? Math.abs(value) : value)) + 0;
    }).join();
    meshes.forEach((contact, at) => {
      const on = meshes.findIndex(({ name, group }) => group === 'bodies' && name === contact.name);
      if (contact.group !== 'contact' || on < 0) return;
      const nodes = new Map();
      for (let node = 0; 3 * node < meshes[on].points.length; node++) nodes.set(key(meshes[on].points, node), node);
      for (let node = 0; 3 * node < contact.points.length; node++) {
        const same = nodes.get(key(contact.points, node));
        if (same === undefined) continue;
        const mirrored = contact.points[3 * node + 1] * meshes[on].points[3 * same + 1] < 0 ? -1 : 1;
        for (const { meshes: states } of frames) {
          const [x, y, z] = states[on].deformation.subarray(3 * same, 3 * same + 3);
          states[at].deformation.set([x, mirrored * y, z], 3 * node);
        }
      }
    });
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

  const inPlane = (points, nodes) => nodes.every(node => Math.abs(points[3 * node + 1]) < 1e-6);

  // Pairs of nodes of edges at which a surface turns by more than 30 degrees or ends; those in the plane y = 0, where a
  // half model is cut, after all others.
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
    const outside = sharp.filter(nodes => !inPlane(points, nodes));
    return { outside: 2 * outside.length, nodes: outside.concat(sharp.filter(nodes => inPlane(points, nodes))).flat() };
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

  // Draws faces as if nearer, by their slope and by the steps of the depths.
  const nearer = (slope, steps) => ({ polygonOffset: true, polygonOffsetFactor: -slope, polygonOffsetUnits: -steps });

  const buffer = (array, size) => new THREE.BufferAttribute(array, size).setUsage(THREE.DynamicDrawUsage);

  // A surface of the data. Its colours are places on the map of its group, which are found per pixel: colours of nodes,
  // if mixed between them, would not be those of the map.
  class Part {
    constructor(mesh, texture, spacing) {
      Object.assign(this, mesh, { object: new THREE.Group() });
      this.sortQuads();
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
      this.surface = new THREE.Mesh(this.geometry, contact
        ? new THREE.MeshBasicMaterial({ map: texture, alphaTest: 0.5, ...nearer(1, 2) })
        : new THREE.MeshLambertMaterial({ map: texture, flatShading: true, ...nearer(-1, -1) }));
      this.lines = new THREE.LineSegments(this.edges, new THREE.LineBasicMaterial(
        { color: contact ? '#ffffff' : '#10202c', transparent: true, opacity: contact ? 0.16 : 0.22 }));
      this.object.add(this.surface, this.lines);
      if (contact) this.addArrows(spacing);
      else this.addOutline();
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

    // Bodies are known by their surfaces, and what a plane cuts off would lay bare their inside. It is filled where
    // along the line of sight there are more back sides than front sides (a stencil).
    addCap(plane, size) {
      const count = (side, stencilZPass) => new THREE.Mesh(this.geometry, new THREE.MeshBasicMaterial({
        side, stencilZPass, stencilWrite: true, stencilFunc: THREE.AlwaysStencilFunc, clippingPlanes: [plane],
        colorWrite: false, depthWrite: false, depthTest: false,
      }));
      const square = new THREE.PlaneGeometry(size, size).rotateX(Math.PI / 2);
      const fill = new THREE.Mesh(square, new THREE.MeshBasicMaterial({
        side: THREE.DoubleSide, stencilWrite: true, stencilFunc: THREE.NotEqualStencilFunc, color: '#c3ccd1',
        ...nearer(-1, -1),
      }));
      fill.onAfterRender = renderer => renderer.clearStencil();
      this.cap = new THREE.Group();
      this.cap.add(count(THREE.BackSide, THREE.IncrementWrapStencilOp));
      this.cap.add(count(THREE.FrontSide, THREE.DecrementWrapStencilOp), fill);
      // all of one body before the other, and before anything else
      const first = (UP[this.name] ?? 0) - 10;
      const drawn = k => ({ frustumCulled: false, renderOrder: first + 0.2 * k });
      this.cap.children.forEach((child, k) => Object.assign(child, drawn(k)));
      this.object.add(this.cap);
    }

    addArrows(spacing) {
      this.arrowLength = Math.max(meanEdge(this), spacing);
      this.arrowNodes = thinned(this.points, this.arrowLength);
      // dark with a light edge, to be seen on all colours; of length one in the plane
      const flat = (edge, z) => [[-edge, -0.07 - edge], [0.6, -0.07 - edge], [0.6, 0.07 + edge],
        [-edge, -0.07 - edge], [0.6, 0.07 + edge], [-edge, 0.07 + edge],
        [0.55 - edge, -0.24 - 2 * edge], [1 + 2 * edge, 0], [0.55 - edge, 0.24 + 2 * edge]].flatMap(at => [...at, z]);
      const shape = new THREE.BufferGeometry();
      const points = new Float32Array([...flat(0.035, 0), ...flat(0, 0.01)]);
      shape.setAttribute('position', new THREE.BufferAttribute(points, 3));
      shape.setAttribute('color', new THREE.BufferAttribute(new Float32Array(54).fill(1, 0, 27), 3));
      const material = new THREE.MeshBasicMaterial({ vertexColors: true, ...nearer(3, 40) });
      this.arrows = new THREE.InstancedMesh(shape, material, this.arrowNodes.length);
      this.object.add(this.arrows);
    }

    // Quads in the plane y = 0, where a half model is cut, come last: they are not drawn where its other half is.
    sortQuads() {
      const quads = Array.from({ length: this.quads.length / 4 }, (_, k) => [...this.quads.subarray(4 * k, 4 * k + 4)]);
      const outside = quads.filter(quad => !inPlane(this.points, quad));
      this.outside = outside.length;
      this.quads = new Uint32Array(outside.concat(quads.filter(quad => inPlane(this.points, quad))).flat());
    }

    // Draws the surface of a body without its faces at y = 0, or with them.
    close(open) {
      const all = this.quads.length / 4;
      this.geometry.setDrawRange(0, 6 * (open ? this.outside : all));
      this.edges.setDrawRange(0, 8 * (open ? this.outside : all));
      this.outline.geometry.setDrawRange(0, this.outline.count[open ? 'outside' : 'all']);
    }

    // Draws the quads that have a node with at least this pressure, and the edges of those with no other; all where no
    // pressures are given.
    drawQuads(pressure, least) {
      const [triangles, edges] = [this.geometry.index, this.edges.index];
      let [t, e] = [0, 0];
      for (let at = 0; at < this.quads.length; at += 4) {
        const [a, b, c, d] = this.quads.subarray(at, at + 4);
        const pressed = pressure ? [a, b, c, d].filter(node => pressure[node] > least).length : 4;
        if (pressed === 0) continue;
        // the diagonal that joins the nodes more alike leaves the edge of a patch smooth
        const other = pressure && Math.abs(pressure[a] - pressure[c]) > Math.abs(pressure[b] - pressure[d]);
        triangles.array.set(other ? [a, b, d, b, c, d] : [a, b, c, a, c, d], t);
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
        if (!pressure || !(largestPressure > 0)) continue;
        uv.array[2 * node + 1] = 0.25 + Math.min(25 * pressure[node] / largestPressure, 0.5);
      }
      position.needsUpdate = uv.needsUpdate = true;
      this.geometry.boundingSphere = null; // the one that picking would make use of
      if (this.group === 'contact') this.drawQuads(pressure, 0.01 * largestPressure);
      this.surface.visible = this.group === 'bodies' || Boolean(values);
    }

    showArrows({ shear_vector: shear }, top) {
      const position = this.geometry.attributes.position;
      const up = new THREE.Vector3(0, 0, UP[this.name] ?? 1);
      const [along, side, at] = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
      const [matrix, thick] = [new THREE.Matrix4(), up.clone().multiplyScalar(this.arrowLength)];
      let count = 0;
      for (const node of shear && top > 0 ? this.arrowNodes : []) {
        along.fromArray(shear, 3 * node).multiplyScalar(1.25 * this.arrowLength / top);
        const length = along.length();
        if (length < 0.06 * this.arrowLength) continue;
        // the middle of an arrow is at its node
        at.fromBufferAttribute(position, node).addScaledVector(along, -0.5);
        at.addScaledVector(up, 0.03 * this.arrowLength);
        side.crossVectors(up, along);
        matrix.makeBasis(along, side, thick).setPosition(at);
        this.arrows.setMatrixAt(count++, matrix);
      }
      this.arrows.count = count;
      this.arrows.instanceMatrix.needsUpdate = true;
    }
  }

  return { MAPS, decoded, place, largestDeformation, mapTexture, Part };
})();
