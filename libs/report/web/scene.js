// SPDX-License-Identifier: BSD-3-Clause
// The picture of the map: three.js draws the faces of voxels.js, as fine as the machine can.
'use strict';
window.csom.Scene = (() => {
  const {TILE, COARSEST, MOST_FACES} = window.csom;
  const REST_FACES = 3e6;  // of a picture that stands still
  const LEAST_FACES = 1e5;  // of one that moves, however slow the machine
  const SLICE_MS = 40;  // of making faces between two pictures
  const SETTLE_MS = 250;  // without a movement

  const VERTEX_SHADER = `
    precision highp float;
    uniform mat4 modelViewMatrix, projectionMatrix;
    uniform sampler2D colors;
    uniform vec4 channel;      // which byte of the values is the colour's
    uniform vec4 heightScale;  // or how a place becomes one
    uniform vec3 tilePlace;
    uniform float shades[6];
    attribute vec4 position, values;  // x, y, z, direction
    varying vec3 color;
    void main() {
      float random = floor(position.w / 8.0);
      int direction = int(position.w - 8.0 * random + 0.5);
      float height = dot(heightScale, vec4(position.xyz + tilePlace, 1.0));
      float index = clamp(dot(channel, values) + height, 0.0, 255.0);
      vec3 base = texture2D(colors, vec2((index + 0.5) / 256.0, 0.5)).rgb;
      float shade = 1.0;
      for (int i = 0; i < 6; ++i) if (i == direction) shade = shades[i];
      color = base * shade * (0.955 + random * 0.0015);
      gl_Position = projectionMatrix * modelViewMatrix * vec4(position.xyz, 1.0);
    }`;
  const FRAGMENT_SHADER = `
    precision mediump float;
    varying vec3 color;
    void main() { gl_FragColor = vec4(color, 1.0); }`;

  /** Positions are in voxels, relative to the middle of the map, so that they stay exact. */
  class Scene {
    constructor(canvas, model) {
      this.model = model;
      this.canvas = canvas;
      this.renderer = new THREE.WebGLRenderer({canvas, antialias: true, alpha: true});
      this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
      this.scene = new THREE.Scene();
      this.camera = new THREE.PerspectiveCamera(40, 1, 1, 1000);
      const {axis, sign} = model.header.up;
      this.camera.up.set(0, 0, 0).setComponent(axis, sign);
      this.readFocus();
      this.makeMaterial(axis, sign);
      this.addTiles();
      this.addMarker();
      this.addControls();
      this.movingFaces = REST_FACES / 2;
      this.lastMove = -Infinity;
      this.wanted = false;
      this.lookFrom('oblique');
      new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    }

    readFocus() {
      const {low, high} = this.model.header.focus;
      this.middle = low.map((l, i) => (l + high[i]) / 2);
      this.radius = Math.max(0.5 * Math.hypot(...high.map((h, i) => h - low[i])), 4);
    }

    makeMaterial(axis, sign) {
      // Light from above, and from one side.
      const shades = [0.86, 0.76, 0.82, 0.7, 0.86, 0.76];
      shades[2 * axis + (sign > 0 ? 0 : 1)] = 1;
      shades[2 * axis + (sign > 0 ? 1 : 0)] = 0.55;
      this.texture = new THREE.DataTexture(new Uint8Array(256 * 4), 256, 1, THREE.RGBAFormat);
      this.uniforms = {
        colors: {value: this.texture},
        channel: {value: new THREE.Vector4()},
        heightScale: {value: new THREE.Vector4()},
        shades: {value: shades},
      };
    }

    addTiles() {
      const corners = new Uint32Array(MOST_FACES * 6);
      for (let face = 0; face < MOST_FACES; ++face) {
        corners.set([0, 1, 2, 0, 2, 3].map((corner) => 4 * face + corner), 6 * face);
      }
      this.corners = new THREE.BufferAttribute(corners, 1);
      const half = TILE / 2;
      this.sphere =
          new THREE.Sphere(new THREE.Vector3(half, half, half), Math.sqrt(3) * half);
      this.drawn = new Map();
      for (const tile of this.model.tiles) {
        const place = Array.from(tile.place, (p) => p * TILE);
        const material = new THREE.RawShaderMaterial({
          vertexShader: VERTEX_SHADER, fragmentShader: FRAGMENT_SHADER,
          uniforms: {...this.uniforms, tilePlace: {value: new THREE.Vector3(...place)}},
        });
        const position =
            new THREE.Vector3(...place.map((p, i) => p - this.middle[i]));
        const middle = position.clone().addScalar(half);
        this.drawn.set(tile, {meshes: [], stale: [], material, position, middle, level: -1});
      }
    }

    addMarker() {
      const box = new THREE.EdgesGeometry(new THREE.BoxBufferGeometry(1, 1, 1));
      this.marker = new THREE.Group();
      // White on black shows on any colour.
      for (const [color, size] of [[0x000000, 1.12], [0xffffff, 1.06]]) {
        const line = new THREE.LineSegments(
            box, new THREE.LineBasicMaterial({color, depthTest: false, transparent: true}));
        line.scale.setScalar(size);
        this.marker.add(line);
      }
      this.marker.visible = false;
      this.scene.add(this.marker);
    }

    addControls() {
      this.controls = new THREE.OrbitControls(this.camera, this.canvas);
      this.controls.enableKeys = false;  // they would take the arrow keys from the whole page
      this.controls.screenSpacePanning = true;
      // The wheel scrolls the page until the picture has the focus.
      this.controls.enableZoom = false;
      this.canvas.addEventListener('focus', () => { this.controls.enableZoom = true; });
      this.canvas.addEventListener('blur', () => { this.controls.enableZoom = false; });
      this.canvas.addEventListener('touchstart', () => this.canvas.focus());
      this.controls.addEventListener('start', () => { this.view = undefined; });
      this.controls.addEventListener('change', () => {
        this.lastMove = performance.now();
        this.request();
      });
    }

    addTrajectories(trajectories) {
      this.path = new THREE.Group();
      const radius = Math.max(0.25, this.radius / 350);
      const material = new THREE.MeshBasicMaterial({color: 0xe4002b});
      const outline = new THREE.MeshBasicMaterial({color: 0xffffff, side: THREE.BackSide});
      for (const points of trajectories) {
        const curve = new THREE.CatmullRomCurve3(
            points.map((p) => new THREE.Vector3(...p.map((c, i) => c - this.middle[i]))), false,
            'centripetal');
        // By number of point, not by length, which would round corners off.
        curve.getPointAt = curve.getPoint;
        curve.getTangentAt = curve.getTangent;
        const steps = 2 * (points.length - 1);
        this.path.add(
            new THREE.Mesh(new THREE.TubeBufferGeometry(curve, steps, radius, 6), material),
            new THREE.Mesh(new THREE.TubeBufferGeometry(curve, steps, 1.6 * radius, 6), outline));
        const start = new THREE.Mesh(new THREE.SphereBufferGeometry(3 * radius, 12, 8), material);
        start.position.copy(curve.points[0]);
        this.path.add(start);
      }
      this.scene.add(this.path);
    }

    setColors(bytes, channel, heightScale) {
      this.texture.image.data.set(bytes);
      this.texture.needsUpdate = true;
      this.uniforms.channel.value.set(...channel);
      this.uniforms.heightScale.value.set(...heightScale);
      this.request();
    }

    lookFrom(view) {
      this.view = view;
      const {axis, sign} = this.model.header.up;
      const up = new THREE.Vector3().setComponent(axis, sign);
      const right = new THREE.Vector3().setComponent(axis === 0 ? 1 : 0, 1);
      const ahead = new THREE.Vector3().crossVectors(up, right);
      const direction = {
        // Not quite from above: there, left and right would have no meaning.
        top: up.clone().addScaledVector(ahead, -1e-3),
        front: ahead.clone().negate(),
        side: right.clone(),
        oblique: up.clone().multiplyScalar(0.75).addScaledVector(ahead, -0.8)
            .addScaledVector(right, -0.45),
      }[view].normalize();
      this.frame(direction);
      this.controls.update();
      this.request();
    }

    /** Looks along `direction` from where the tiles in the focus of the map fill the picture. */
    frame(direction) {
      const axes = new THREE.Matrix4().lookAt(direction, new THREE.Vector3(), this.camera.up);
      const toAxes = new THREE.Matrix4().getInverse(axes);
      const vertical = 0.96 * Math.tan(this.camera.fov * Math.PI / 360);
      const slopes = [vertical * this.camera.aspect, vertical];
      // How far away the camera must be for a side of the picture not to cut the map.
      const least = [[-Infinity, -Infinity], [-Infinity, -Infinity]];
      const point = new THREE.Vector3();
      for (const corner of this.cornersOfFocus()) {
        const {x, y, z} = point.set(...corner).applyMatrix4(toAxes);
        [x, y].forEach((across, i) => {
          least[i][0] = Math.max(least[i][0], z - across / slopes[i]);
          least[i][1] = Math.max(least[i][1], z + across / slopes[i]);
        });
      }
      const [right, up] = least.map(([a, b], i) => slopes[i] * (b - a) / 2);
      const distance = Math.max(...least.map(([a, b]) => (a + b) / 2));
      this.controls.target.set(right, up, 0).applyMatrix4(axes);
      this.camera.position.set(right, up, Math.max(distance, 4)).applyMatrix4(axes);
    }

    cornersOfFocus() {
      const {low, high} = this.model.header.focus;
      const corners = [];
      for (const tile of this.model.tiles) {
        const from = low.map((l, i) => Math.max(l, tile.place[i] * TILE));
        const to = high.map((h, i) => Math.min(h, (tile.place[i] + 1) * TILE));
        if (from.some((f, i) => f >= to[i])) continue;
        for (let corner = 0; corner < 8; ++corner) {
          corners.push(
              this.middle.map((m, i) => (corner >> i & 1 ? to : from)[i] - m));
        }
      }
      return corners;
    }

    turn(horizontal, vertical) {
      this.view = undefined;
      const toPole = new THREE.Quaternion().setFromUnitVectors(
          this.camera.up, new THREE.Vector3(0, 1, 0));
      const offset = this.camera.position.clone().sub(this.controls.target).applyQuaternion(toPole);
      const angles = new THREE.Spherical().setFromVector3(offset);
      angles.theta += horizontal;
      angles.phi = Math.min(Math.max(angles.phi + vertical, 1e-3), Math.PI - 1e-3);
      offset.setFromSpherical(angles).applyQuaternion(toPole.clone().inverse());
      this.camera.position.copy(this.controls.target).add(offset);
      this.controls.update();
    }

    /** By shares of the distance, as seen on the screen. */
    move(right, up) {
      this.view = undefined;
      const distance = this.camera.position.distanceTo(this.controls.target);
      const step = new THREE.Vector3(right * distance, up * distance, 0)
          .applyQuaternion(this.camera.quaternion);
      this.camera.position.add(step);
      this.controls.target.add(step);
      this.controls.update();
    }

    zoom(factor) {
      this.view = undefined;
      const offset = this.camera.position.clone().sub(this.controls.target);
      this.camera.position.copy(this.controls.target).addScaledVector(offset, factor);
      this.controls.update();
    }

    /** The faces of these tiles have changed. */
    renew(tiles) {
      for (const tile of tiles) this.drawn.get(tile).stale = [true, true, true];
      this.request();
    }

    /** A new picture; until it is there in all detail, data-picture of the canvas says "stale". */
    request() {
      this.canvas.dataset.picture = 'stale';
      if (this.wanted) return;
      this.wanted = true;
      requestAnimationFrame(() => {
        this.wanted = false;
        this.draw();
      });
    }

    resize() {
      const {clientWidth, clientHeight} = this.canvas.parentElement;
      if (clientWidth === 0 || clientHeight === 0) return;
      this.renderer.setSize(clientWidth, clientHeight, false);
      this.camera.aspect = clientWidth / clientHeight;
      this.camera.updateProjectionMatrix();
      if (this.view) this.lookFrom(this.view);
      this.request();
    }

    faceCount(tile, level) {
      const drawn = this.drawn.get(tile);
      if (drawn.meshes[level] && !drawn.stale[level]) return drawn.meshes[level].userData.faces;
      return 2 * tile.visibleCount / 4 ** level;
    }

    /** Chooses a level of detail for each tile in view. Finer ones near, within the budget. */
    chooseLevels(budget) {
      const frustum = new THREE.Frustum().setFromMatrix(new THREE.Matrix4().multiplyMatrices(
          this.camera.projectionMatrix, this.camera.matrixWorldInverse));
      const pixels = this.renderer.getDrawingBufferSize(new THREE.Vector2()).y /
          (2 * Math.tan(this.camera.fov * Math.PI / 360));
      const inView = [];
      for (const [tile, drawn] of this.drawn) {
        drawn.level = -1;
        if (tile.visibleCount === 0) continue;
        const sphere = new THREE.Sphere(drawn.middle, this.sphere.radius);
        if (!frustum.intersectsSphere(sphere)) continue;
        const distance =
            Math.max(this.camera.position.distanceTo(drawn.middle) - TILE / 2, TILE / 2);
        inView.push({tile, drawn, pixelsOfVoxel: pixels / distance});
      }
      inView.sort((a, b) => b.pixelsOfVoxel - a.pixelsOfVoxel);
      for (let least = 0.6;; least *= 1.25) {
        let faces = 0;
        for (const {tile, drawn, pixelsOfVoxel} of inView) {
          const level = Math.ceil(Math.log2(least / pixelsOfVoxel));
          drawn.level = Math.min(Math.max(level, 0), COARSEST);
          faces += this.faceCount(tile, drawn.level);
        }
        if (faces <= budget || least > 1e4) break;
      }
      return inView;
    }

    make(tile, drawn, level) {
      const old = drawn.meshes[level];
      if (old) {
        this.scene.remove(old);
        old.geometry.setIndex(null);  // that of all tiles, which stays
        old.geometry.dispose();
      }
      const {places, values} = this.model.faces(tile, level);
      const bytes = (words) => new THREE.BufferAttribute(new Uint8Array(words.buffer), 4);
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', bytes(places));
      geometry.setAttribute('values', bytes(values));
      geometry.setIndex(this.corners);
      geometry.setDrawRange(0, places.length / 4 * 6);
      geometry.boundingSphere = this.sphere;
      const mesh = new THREE.Mesh(geometry, drawn.material);
      mesh.userData.faces = places.length / 4;
      mesh.position.copy(drawn.position);
      mesh.matrixAutoUpdate = false;
      mesh.updateMatrix();
      drawn.meshes[level] = mesh;
      drawn.stale[level] = false;
      this.scene.add(mesh);
    }

    /** Makes missing faces, the coarse ones first, for a while. True if all are there. */
    makeFaces(inView) {
      const end = performance.now() + SLICE_MS;
      for (const exact of [false, true]) {
        for (const {tile, drawn} of inView) {
          const level = exact ? drawn.level : COARSEST;
          if (drawn.meshes[level] && !drawn.stale[level]) continue;
          if (!exact && this.isReady(drawn, drawn.level)) continue;
          this.make(tile, drawn, level);
          if (exact && performance.now() > end) return false;
        }
      }
      return true;
    }

    isReady(drawn, level) {
      return drawn.meshes[level] !== undefined && !drawn.stale[level];
    }

    /** The level that the picture shows of a tile. */
    shownLevel(drawn) {
      return this.isReady(drawn, drawn.level) ? drawn.level : COARSEST;
    }

    draw() {
      const start = performance.now();
      const moving = start - this.lastMove < SETTLE_MS;
      this.camera.updateMatrixWorld();
      const inView = this.chooseLevels(moving ? this.movingFaces : REST_FACES);
      const complete = this.makeFaces(inView);
      const shown = new Set();
      for (const {drawn} of inView) shown.add(drawn.meshes[this.shownLevel(drawn)]);
      for (const drawn of this.drawn.values()) {
        for (const mesh of drawn.meshes) if (mesh) mesh.visible = shown.has(mesh);
      }
      const distance = this.camera.position.length();
      this.camera.far = distance + 4 * this.radius + 2 * TILE;
      this.camera.near = Math.max(0.2, (distance - 2 * this.radius) / 2);
      this.camera.updateProjectionMatrix();
      this.renderer.render(this.scene, this.camera);
      this.coarsest = Math.max(0, ...inView.map(({drawn}) => this.shownLevel(drawn)));
      if (complete) this.canvas.dataset.picture = 'complete';
      this.markOnce('csom-first-picture');
      if (complete) this.markOnce('csom-complete-picture');
      if (this.onDrawn) this.onDrawn();

      if (!complete) this.request();
      if (!moving) return;
      this.adaptTo(start);
      clearTimeout(this.settling);
      this.settling = setTimeout(() => this.request(), SETTLE_MS + 10);
    }

    /** For whoever measures how long the page takes. */
    markOnce(name) {
      if (performance.getEntriesByName(name).length === 0) performance.mark(name);
    }

    /** As many faces as this machine draws in a twentieth of a second. */
    adaptTo(start) {
      const elapsed = start - (this.lastDraw || 0);
      this.lastDraw = start;
      if (elapsed > 500) return;  // the first picture of a movement
      if (elapsed > 60) this.movingFaces = Math.max(LEAST_FACES, 0.7 * this.movingFaces);
      if (elapsed < 30) this.movingFaces = Math.min(REST_FACES, 1.1 * this.movingFaces);
    }

    /** What is at a point of the canvas [CSS pixels]; undefined if nothing is. */
    pick(x, y) {
      const {clientWidth, clientHeight} = this.canvas;
      const ray = new THREE.Raycaster();
      ray.setFromCamera(
          {x: 2 * x / clientWidth - 1, y: 1 - 2 * y / clientHeight}, this.camera);
      const origin = ray.ray.origin.toArray().map((c, i) => c + this.middle[i]);
      return this.model.cast(
          origin, ray.ray.direction.toArray(), (tile) => this.shownLevel(this.drawn.get(tile)));
    }

    mark(hit) {
      this.marker.visible = hit !== undefined;
      if (hit) {
        this.marker.position.set(
            ...hit.corner.map((c, i) => c + hit.size / 2 - this.middle[i]));
        this.marker.scale.setScalar(hit.size);
      }
      this.request();
    }
  }

  return Scene;
})();
