"""The folder of attacked robots: a package with meshes good and bad, traps beside it, and a secret elsewhere."""

from __future__ import annotations

import os
import struct
import zipfile
import zlib
from pathlib import Path

__all__ = ["Sandbox"]

TRIANGLE = ((0.0, 0.0, 1.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
NOT_A_NUMBER = (TRIANGLE[0], TRIANGLE[1], (float("nan"), 0.0, 0.0), (0.0, float("inf"), 0.0))
POINTER = b"version https://git-lfs.github.com/spec/v1\noid sha256:" + b"0" * 64 + b"\nsize 12345\n"
GARBAGE = bytes(range(256)) * 8
MEGABYTE = 1024 * 1024
BOMB_MEGABYTES = 3 * 1024
BOMB_CRC = 0x480BBE37  # of so many zeros
GLTF = """{"asset": {"version": "2.0"}, "buffers": [{"uri": "@OUTSIDE@/secret.bin", "byteLength": 36}],
"images": [{"uri": "@OUTSIDE@/secret.png"}], "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"bufferViews": [{"buffer": 0, "byteLength": 36}], "textures": [{"source": 0}],
"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}]}"""
DAE = """<?xml version="1.0"?>%s
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit meter="1"/></asset>
<library_images><image id="i"><init_from>%s</init_from></image></library_images></COLLADA>"""
BOMB = '<!DOCTYPE x [<!ENTITY e0 "0">' + "".join(f'<!ENTITY e{i + 1} "{f"&e{i};" * 10}">' for i in range(9)) + "]>"


class Sandbox:
    """The folder of the attack.

    Attributes:
        package: The package "victim", in whose folder `urdf` the robots stand.
        outside: A folder that no robot may read.
        robot: The file of the robot under attack.
        plain: The same robot in plain form.
    """

    def __init__(self, folder: Path) -> None:
        workspace = folder.resolve() / "workspace"
        self.package = workspace / "victim"
        # Deep enough that no folder above the robot is a parent of a package of this name.
        self.outside = folder.resolve() / "elsewhere" / "deep"
        meshes = self.package / "meshes"
        for one in (self.package / "urdf", meshes, self.outside, workspace / "neighbour", workspace / "checkout"):
            one.mkdir(parents=True)
        self.robot, self.plain = self.package / "urdf" / "robot.urdf", self.package / "urdf" / "plain.urdf"
        self._manifests(workspace)
        self._meshes(meshes)
        for name in ("secret.stl", "secret.png", "secret.bin", "secret.mtl"):
            (self.outside / name).write_bytes(_stl(TRIANGLE))

    def filled(self, document: bytes) -> bytes:
        """The document with this machine's folders in its addresses."""
        up = "../" * (len(self.robot.parts) - 2)
        return document.replace(b"@UP@@OUTSIDE@", (up + str(self.outside)[1:]).encode()).replace(
            b"@OUTSIDE@", str(self.outside).encode()
        )

    def _manifests(self, workspace: Path) -> None:
        (self.package / "package.xml").write_text("<package><name>victim</name></package>")
        (workspace / "checkout" / "package.xml").write_text("<package><name>by_manifest</name></package>")
        (workspace / "checkout" / "ok.stl").write_bytes(_stl(TRIANGLE))
        (workspace / "neighbour" / "ok.stl").write_bytes(_stl(TRIANGLE))
        for name in ("manifest_fifo", "manifest_zero", "manifest_folder", "manifest_garbage"):
            (workspace / name).mkdir()
        os.mkfifo(workspace / "manifest_fifo" / "package.xml")
        (workspace / "manifest_zero" / "package.xml").symlink_to("/dev/zero")
        (workspace / "manifest_folder" / "package.xml").mkdir()
        (workspace / "manifest_garbage" / "package.xml").write_bytes(GARBAGE)

    def _meshes(self, meshes: Path) -> None:
        (meshes / "ok.stl").write_bytes(_stl(TRIANGLE))
        (meshes / "nan.stl").write_bytes(_stl(NOT_A_NUMBER))
        (meshes / "huge.stl").write_bytes(b"\0" * 80 + struct.pack("<I", 2**32 - 1) + b"\0" * 50)
        (meshes / "empty.stl").write_bytes(b"")
        (meshes / "pointer.stl").write_bytes(POINTER)
        for kind in ("stl", "dae", "obj", "ply", "glb"):
            (meshes / f"garbage.{kind}").write_bytes(GARBAGE)
        os.mkfifo(meshes / "fifo.stl")
        (meshes / "zero.stl").symlink_to("/dev/zero")
        (meshes / "loop.stl").symlink_to("loop.stl")
        secret = str(self.outside / "secret")
        (meshes / "names_outside.obj").write_text(f"mtllib {secret}.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        (meshes / "names_outside.gltf").write_text(GLTF.replace("@OUTSIDE@", str(self.outside)))
        (meshes / "names_outside.dae").write_text(DAE % ("", f"{secret}.png"))
        (meshes / "bomb.dae").write_text(DAE % (BOMB, "&e9;"))
        for name, inside in (("bomb.zip", "a.stl"), ("bomb.3mf", "3D/3dmodel.model")):
            (meshes / name).write_bytes(_zip_bomb(inside.encode()))
        with zipfile.ZipFile(meshes / "a.zip", "w") as archive:
            archive.writestr("ok.stl", _stl(TRIANGLE))


def _zip_bomb(inside: bytes) -> bytes:
    """An archive of 3 MB whose only file has 3 GB of zeros, all from the same compressed block."""
    deflate = zlib.compressobj(9, zlib.DEFLATED, -15)
    block = deflate.compress(b"\0" * MEGABYTE) + deflate.flush(zlib.Z_FULL_FLUSH)
    packed = block * BOMB_MEGABYTES + deflate.flush(zlib.Z_FINISH)
    about = struct.pack(
        "<HHHHHIIIHH", 20, 0, 8, 0, 0x21, BOMB_CRC, len(packed), BOMB_MEGABYTES * MEGABYTE, len(inside), 0
    )
    stored = b"PK\3\4" + about + inside + packed
    listed = b"PK\1\2" + struct.pack("<H", 20) + about + struct.pack("<HHHII", 0, 0, 0, 0, 0) + inside
    return stored + listed + b"PK\5\6" + struct.pack("<HHHHIIH", 0, 0, 1, 1, len(listed), len(stored), 0)


def _stl(triangle: tuple[tuple[float, ...], ...]) -> bytes:
    return b"\0" * 80 + struct.pack("<I", 1) + b"".join(struct.pack("<3f", *row) for row in triangle) + b"\0\0"
