// SPDX-License-Identifier: BSD-3-Clause
// The voxels of the page: which of them are visible, and the faces that one can see of them.
'use strict';
window.csom = (() => {
  const TILE = 32;  // voxels along the edge of a tile: a row of them is a word of bits
  const WORDS = TILE * TILE;
  const COARSEST = 2;  // level of detail at which a cube stands for 4×4×4 voxels
  const MOST_FACES = 3 * TILE * TILE * TILE;  // of a tile: those of a chequerboard

  // Corners of the faces towards +x −x +y −y +z −z, counter-clockwise seen from outside.
  const CORNERS = [
    [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]], [[0, 0, 0], [0, 0, 1], [0, 1, 1], [0, 1, 0]],
    [[0, 1, 0], [0, 1, 1], [1, 1, 1], [1, 1, 0]], [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]],
    [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], [[0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0, 0]],
  ];

  function bitCount(word) {
    word -= (word >>> 1) & 0x55555555;
    word = (word & 0x33333333) + ((word >>> 2) & 0x33333333);
    return Math.imul((word + (word >>> 4)) & 0x0f0f0f0f, 0x01010101) >>> 24;
  }

  /** Calls visit(bit) for every bit that is set, the lowest first. */
  function forEachBit(word, visit) {
    while (word !== 0) {
      const bit = 31 - Math.clz32(word & -word);
      visit(bit);
      word &= word - 1;
    }
  }

  async function inflate(base64) {
    const text = atob(base64);
    const packed = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
    return new Response(stream).arrayBuffer();
  }

  /** 32×32×32 voxels. `visible` has a bit for each voxel that is there and switched on. */
  class Tile {
    constructor(place, occupied, firstVoxel) {
      this.place = place;
      this.occupied = occupied;
      this.visible = new Uint32Array(WORDS);
      this.neighbours = [];
      this.firstOfWord = new Uint32Array(WORDS);
      for (let i = 0, voxel = firstVoxel; i < WORDS; ++i) {
        this.firstOfWord[i] = voxel;
        voxel += bitCount(occupied[i]);
      }
      this.visibleCount = 0;
      this.coarse = [];  // by level, made when asked for
    }

    voxelAt(x, y, z) {
      const word = z * TILE + y;
      const below = this.occupied[word] & ((1 << x) - 1);
      return this.firstOfWord[word] + bitCount(below);
    }
  }

  class VoxelModel {
    static async unpack(header, base64) {
      return new VoxelModel(header, await inflate(base64));
    }

    constructor(header, buffer) {
      this.header = header;
      let at = 0;
      const take = (Type, count) => {
        const part = new Type(buffer, at, count);
        at += part.byteLength;
        return part;
      };
      const places = take(Int32Array, 3 * header.tiles);
      const occupied = take(Uint32Array, WORDS * header.tiles);
      const vectorSizes = take(Uint8Array, header.voxels);
      const variance = take(Uint8Array, header.voxels);
      const evidence = take(Uint8Array, header.voxels);
      this.vectorClasses = take(Uint8Array, header.vectorEntries);
      this.vectorProbabilities = take(Uint8Array, header.vectorEntries);

      // Class, probability, variance and evidence in the four bytes of a word, as the shader gets
      // them.
      this.values = new Uint32Array(header.voxels);
      this.vectorBegin = new Uint32Array(header.voxels + 1);
      for (let i = 0, entry = 0; i < header.voxels; ++i) {
        this.vectorBegin[i] = entry;
        this.values[i] = this.vectorClasses[entry] | this.vectorProbabilities[entry] << 8 |
            variance[i] << 16 | evidence[i] << 24;
        entry += vectorSizes[i];
        this.vectorBegin[i + 1] = entry;
      }
      this.readTiles(places, occupied);
      this.faceScratch = {
        places: new Uint32Array(4 * MOST_FACES), values: new Uint32Array(4 * MOST_FACES),
      };
    }

    readTiles(places, occupied) {
      this.tiles = [];
      this.tileAt = new Map();
      let voxel = 0;
      for (let t = 0; t < this.header.tiles; ++t) {
        const words = occupied.subarray(t * WORDS, (t + 1) * WORDS);
        const tile = new Tile(places.subarray(3 * t, 3 * t + 3), words, voxel);
        for (const word of words) voxel += bitCount(word);
        this.tiles.push(tile);
        this.tileAt.set(tile.place.join(), tile);
      }
      const sides = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
      for (const tile of this.tiles) {
        tile.neighbours =
            sides.map((side) => this.tileAt.get(side.map((s, i) => tile.place[i] + s).join()));
      }
    }

    /**
     * Shows the voxels of the classes for which shown[class] is true and whose index along the up
     * axis is from `lowest` to `highest`. Returns the tiles whose picture changes.
     */
    show(shown, lowest, highest) {
      const {axis} = this.header.up;
      const changed = new Set();
      this.visibleCount = 0;
      for (const tile of this.tiles) {
        const base = tile.place[axis] * TILE;
        let count = 0;
        let differs = false;
        for (let i = 0; i < WORDS; ++i) {
          let voxel = tile.firstOfWord[i];
          let visible = 0;
          const y = i % TILE;
          const z = i / TILE | 0;
          forEachBit(tile.occupied[i], (x) => {
            const height = base + (axis === 0 ? x : axis === 1 ? y : z);
            if (shown[this.values[voxel] & 255] && height >= lowest && height <= highest) {
              visible |= 1 << x;
              ++count;
            }
            ++voxel;
          });
          differs = differs || (visible >>> 0) !== tile.visible[i];
          tile.visible[i] = visible;
        }
        tile.visibleCount = count;
        this.visibleCount += count;
        if (!differs) continue;
        tile.coarse = [];
        changed.add(tile);
        for (const neighbour of tile.neighbours) if (neighbour) changed.add(neighbour);
      }
      return changed;
    }

    /** The visible voxels of a tile in cubes of 2^level: bits of rows, and a voxel a cube. */
    coarse(tile, level) {
      if (tile.coarse[level]) return tile.coarse[level];
      const n = TILE >> level;
      const rows = new Uint32Array(n * n);
      const voxels = new Uint32Array(n * n * n);
      for (let i = 0; i < WORDS; ++i) {
        const row = ((i / TILE | 0) >> level) * n + ((i % TILE) >> level);
        forEachBit(tile.visible[i], (x) => {
          const cube = row * n + (x >> level);
          const bit = 1 << (x >> level);
          const voxel = tile.voxelAt(x, i % TILE, i / TILE | 0);
          // The cube shows the voxel of which most is known.
          const better = this.values[voxel] >>> 24 > this.values[voxels[cube]] >>> 24;
          if ((rows[row] & bit) === 0 || better) voxels[cube] = voxel;
          rows[row] |= bit;
        });
      }
      tile.coarse[level] = {rows, voxels};
      return tile.coarse[level];
    }

    /** Which cubes of a row have a free face towards each of the six directions. */
    freeFaces(tile, level, rows, y, z) {
      const n = TILE >> level;
      const last = n - 1;
      const i = z * n + y;
      const word = rows[i];
      // A neighbour of another level of detail may not cover what one sees past this cube.
      const beyond = (side, index) => {
        const neighbour = level === 0 ? tile.neighbours[side] : undefined;
        return neighbour ? neighbour.visible[index] : 0;
      };
      return [
        word & ~(word >>> 1 | beyond(0, i) << 31),
        word & ~(word << 1 | beyond(1, i) >>> 31),
        word & ~(y < last ? rows[i + 1] : beyond(2, z * n)),
        word & ~(y > 0 ? rows[i - 1] : beyond(3, z * n + last)),
        word & ~(z < last ? rows[i + n] : beyond(4, y)),
        word & ~(z > 0 ? rows[i - n] : beyond(5, last * n + y)),
      ];
    }

    /**
     * The faces of a tile as quads, four corners a face. `places`: x, y, z of the corner and the
     * face's direction, with some random bits above it, a byte each; `values`: as in this.values.
     */
    faces(tile, level) {
      const n = TILE >> level;
      const cubes = level > 0 ? this.coarse(tile, level) : null;
      const rows = cubes ? cubes.rows : tile.visible;
      const {places, values} = this.faceScratch;
      let end = 0;
      for (let z = 0; z < n; ++z) {
        for (let y = 0; y < n; ++y) {
          if (rows[z * n + y] === 0) continue;
          const free = this.freeFaces(tile, level, rows, y, z);
          for (let direction = 0; direction < 6; ++direction) {
            forEachBit(free[direction], (x) => {
              const voxel =
                  cubes ? cubes.voxels[(z * n + y) * n + x] : tile.voxelAt(x, y, z);
              const random = Math.imul(voxel + 1, 0x9e3779b1) >>> 27;
              const tail = (direction | random << 3) << 24;
              for (const [dx, dy, dz] of CORNERS[direction]) {
                places[end] =
                    (x + dx) << level | (y + dy) << level << 8 | (z + dz) << level << 16 | tail;
                values[end++] = this.values[voxel];
              }
            });
          }
        }
      }
      return {places: places.slice(0, end), values: values.slice(0, end)};
    }

    /**
     * The first visible voxel along a ray [voxels], as it is drawn with the levels of detail that
     * levelOf(tile) tells; undefined if it hits nothing.
     */
    cast(origin, direction, levelOf) {
      const {low, high} = this.bounds();
      let enter = 0;
      let leave = Infinity;
      for (let i = 0; i < 3; ++i) {
        const a = (low[i] - origin[i]) / direction[i];
        const b = (high[i] - origin[i]) / direction[i];
        if (Number.isNaN(a) || Number.isNaN(b)) continue;  // along a side of the box
        enter = Math.max(enter, Math.min(a, b));
        leave = Math.min(leave, Math.max(a, b));
      }
      const cell = origin.map((o, i) => Math.floor(o + direction[i] * (enter + 1e-6)));
      const next = cell.map((c, i) => direction[i] === 0 ?
        Infinity : (c + (direction[i] > 0 ? 1 : 0) - origin[i]) / direction[i]);
      for (let t = enter; t <= leave;) {
        const hit = this.hitAt(cell, levelOf);
        if (hit) return hit;
        const axis = next.indexOf(Math.min(...next));
        t = next[axis];
        next[axis] += Math.abs(1 / direction[axis]);
        cell[axis] += Math.sign(direction[axis]);
      }
      return undefined;
    }

    hitAt(cell, levelOf) {
      const tile = this.tileAt.get(cell.map((c) => Math.floor(c / TILE)).join());
      if (!tile) return undefined;
      const level = levelOf(tile);
      const [x, y, z] = cell.map((c) => (c & (TILE - 1)) >> level);
      const n = TILE >> level;
      const cubes = level > 0 ? this.coarse(tile, level) : null;
      const rows = cubes ? cubes.rows : tile.visible;
      if ((rows[z * n + y] >>> x & 1) === 0) return undefined;
      const voxel = cubes ? cubes.voxels[(z * n + y) * n + x] : tile.voxelAt(x, y, z);
      const size = 1 << level;
      return {voxel, size, corner: cell.map((c) => Math.floor(c / size) * size)};
    }

    bounds() {
      if (this.box) return this.box;
      const low = [Infinity, Infinity, Infinity];
      const high = [-Infinity, -Infinity, -Infinity];
      for (const tile of this.tiles) {
        for (let i = 0; i < 3; ++i) {
          low[i] = Math.min(low[i], tile.place[i] * TILE);
          high[i] = Math.max(high[i], (tile.place[i] + 1) * TILE);
        }
      }
      this.box = {low, high};
      return this.box;
    }

    /** The classes of a voxel with their probabilities, the most likely first. */
    classVector(voxel) {
      const vector = [];
      for (let i = this.vectorBegin[voxel]; i < this.vectorBegin[voxel + 1]; ++i) {
        vector.push(
            {id: this.vectorClasses[i], probability: this.vectorProbabilities[i] / 255});
      }
      return vector;
    }

    /** The value that a byte of a logarithmic range stands for. */
    static valueOf(range, byte) {
      return range.min * (range.max / range.min) ** (byte / 255);
    }
    variance(voxel) {
      return VoxelModel.valueOf(this.header.variance, this.values[voxel] >>> 16 & 255);
    }
    evidence(voxel) {
      return VoxelModel.valueOf(this.header.evidence, this.values[voxel] >>> 24);
    }
  }

  return {VoxelModel, TILE, COARSEST, MOST_FACES};
})();
