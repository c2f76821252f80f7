/** meshcat's viewer and its three.js. Its classic script runs before any module. */

export const { THREE, Viewer } = globalThis.MeshCat;
