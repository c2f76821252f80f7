/** The cells of a map as cubes, cut open towards the camera. */

import { THREE } from "pinik/three.js";

const EDGE = 0.96; // of a cell, so that neighbours are told apart
const BRIGHT = 1.35; // so that colours in the light are about those of the scale
const NEIGHBOURS = [
    [1, 0, 0],
    [-1, 0, 0],
    [0, 1, 0],
    [0, -1, 0],
    [0, 0, 1],
    [0, 0, -1],
];

export class Cells {
    /** @param map the map: its grid, and the numbers and quantities of its cells */
    constructor(map) {
        this._map = map;
        this.group = new THREE.Group();
        const count = map.cells.length;
        const box = new THREE.BoxGeometry(EDGE * map.size, EDGE * map.size, EDGE * map.size);
        this._mesh = new THREE.InstancedMesh(box, new THREE.MeshLambertMaterial(), count);
        this._mesh.frustumCulled = false;
        this._mesh.setColorAt(0, new THREE.Color());
        this.group.add(this._mesh);
        const [, ny, nz] = map.shape;
        this._at = Array.from(map.cells, (cell) => [Math.floor(cell / (ny * nz)), Math.floor(cell / nz) % ny, cell % nz]);
        this._shown = new Uint8Array(map.shape.reduce((a, b) => a * b));
        this.count = 0;
        this._drawn = [];
    }

    /** The centre of a cell by its row. */
    center(row) {
        return new THREE.Vector3(...this._at[row].map((k, axis) => this._map.origin[axis] + k * this._map.size));
    }

    /**
     * Draw the cells that pass.
     *
     * @param passes a function of a cell's row
     * @param cuts for each axis the index of the cut, or null
     * @param sides for each axis 1 or −1: on which side of a cut cells are removed
     * @param layers whether only the layers at the cuts are drawn
     * @param color a function of a cell's row that returns [red, green, blue] in 0..1
     */
    draw({ passes, cuts, sides, layers, color }) {
        const [, ny, nz] = this._map.shape;
        const cutting = [0, 1, 2].filter((axis) => cuts[axis] !== null);
        const removed = (at) => {
            if (!cutting.length) return false;
            if (layers) return cutting.every((axis) => at[axis] !== cuts[axis]);
            return cutting.every((axis) => (at[axis] - cuts[axis]) * sides[axis] > 0);
        };
        this._shown.fill(0);
        this.count = 0;
        const rows = [];
        this._at.forEach((at, row) => {
            if (!passes(row)) return;
            this.count += 1;
            if (removed(at)) return;
            this._shown[(at[0] * ny + at[1]) * nz + at[2]] = 1;
            rows.push(row);
        });
        this._drawn = rows.filter((row) => this._isOutside(this._at[row]));
        const [matrix, shade] = [new THREE.Matrix4(), new THREE.Color()];
        this._drawn.forEach((row, k) => {
            this._mesh.setMatrixAt(k, matrix.setPosition(this.center(row)));
            this._mesh.setColorAt(k, shade.setRGB(...color(row)).convertSRGBToLinear().multiplyScalar(BRIGHT));
        });
        this._mesh.count = this._drawn.length;
        this._mesh.instanceMatrix.needsUpdate = true;
        this._mesh.instanceColor.needsUpdate = true;
    }

    /** Whether a neighbour of a cell is not drawn, so that the cell can be seen. */
    _isOutside(at) {
        const { shape } = this._map;
        return NEIGHBOURS.some((step) => {
            const [x, y, z] = at.map((k, axis) => k + step[axis]);
            const inside = x >= 0 && y >= 0 && z >= 0 && x < shape[0] && y < shape[1] && z < shape[2];
            return !inside || !this._shown[(x * shape[1] + y) * shape[2] + z];
        });
    }

    /** The row of the cell that a ray meets first, and null if it meets none. */
    under(raycaster) {
        const hit = raycaster.intersectObject(this._mesh)[0];
        return hit ? this._drawn[hit.instanceId] : null;
    }
}
