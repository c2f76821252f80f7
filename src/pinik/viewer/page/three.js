/** meshcat's viewer and the three.js inside it; its classic script has run before any module. */

export const { THREE, Viewer } = globalThis.MeshCat;
