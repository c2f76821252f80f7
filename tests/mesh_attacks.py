"""Mesh files that would take all memory, hang a reader or open other files, made small by the attacker."""

from __future__ import annotations

import gzip
import io
import json
import struct
import zipfile
from pathlib import Path

TRIANGLE = "0 0 0 1 0 0 0 1 0"


def stl(triangles: int, announced: int | None = None) -> bytes:
    one = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    return b"\0" * 80 + struct.pack("<I", triangles if announced is None else announced) + one * triangles


def collada(nodes: str = "", unit: str = '<unit meter="1"/>', up: str = "Z_UP", numbers: str = TRIANGLE) -> bytes:
    nodes = nodes or '<node id="n"><instance_geometry url="#g"/></node>'
    return f"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><created>2020-01-01T00:00:00</created><modified>2020-01-01T00:00:00</modified>{unit}
<up_axis>{up}</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">{numbers}</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">{nodes}</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>""".encode()


def doubled(levels: int) -> bytes:
    """A COLLADA scene of 2**levels triangles: each node holds the one before twice."""
    inner = '<node id="n0"><instance_geometry url="#g"/></node>'
    nodes = "".join(
        f'<node id="n{i}">{"".join(f"""<instance_node url="#n{i - 1}"/>""" for _ in range(2))}</node>'
        for i in range(1, levels)
    )
    library = f"<library_nodes>{inner}{nodes}</library_nodes><library_visual_scenes>"
    whole = collada(f'<node id="top"><instance_node url="#n{levels - 1}"/></node>')
    return whole.replace(b"<library_visual_scenes>", library.encode())


def gltf(accessors: list[dict[str, object]], nodes: int = 1, buffers: list[dict[str, object]] | None = None) -> bytes:
    tree = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": list(range(nodes))}],
        "nodes": [{"mesh": 0, "name": str(i)} for i in range(nodes)],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": accessors,
        "buffers": buffers or [],
        "bufferViews": [{"buffer": 0, "byteLength": 36}] if buffers else [],
    }
    return json.dumps(tree).encode()


def zipped(name: str, data: bytes) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(name, data)
    return file.getvalue()


def ply(vertices: int, faces: int, body: bytes, form: str = "binary_little_endian", extra: str = "") -> bytes:
    return (
        f"ply\nformat {form} 1.0\n{extra}element vertex {vertices}\nproperty float x\nproperty float y\n"
        f"property float z\nelement face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
    ).encode() + body


LAUGHS = b"""<?xml version="1.0"?>
<!DOCTYPE COLLADA [<!ENTITY a "0123456789"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">
<!ENTITY c "&b;&b;&b;&b;&b;&b;&b;&b;&b;&b;"><!ENTITY d "&c;&c;&c;&c;&c;&c;&c;&c;&c;&c;">
<!ENTITY e "&d;&d;&d;&d;&d;&d;&d;&d;&d;&d;"><!ENTITY f "&e;&e;&e;&e;&e;&e;&e;&e;&e;&e;">
<!ENTITY g "&f;&f;&f;&f;&f;&f;&f;&f;&f;&f;"><!ENTITY h "&g;&g;&g;&g;&g;&g;&g;&g;&g;&g;">]>
<COLLADA><asset><x>&h;&h;&h;&h;</x></asset></COLLADA>"""
ENTITY = b'<?xml version="1.0"?><!DOCTYPE COLLADA [<!ENTITY x SYSTEM "file:///etc/hostname">]><COLLADA>&x;</COLLADA>'


def attacks() -> dict[str, tuple[bytes, str]]:
    """File name → its contents, and words of the refusal."""
    big = b"v 0 0 0\n" * 1_000_000
    long = [{"componentType": 5126, "type": "MAT4", "count": 10**9}]
    return {
        "lfs.stl": (
            b"version https://git-lfs.github.com/spec/v1\noid sha256:0000\nsize 12345\n",
            "a Git LFS pointer and not the mesh itself",
        ),
        "part.step": (b"ISO-10303-21;\nHEADER;\nENDSEC;\n", "a STEP file"),
        "part.stl": (b"ISO-10303-21;\nHEADER;\nENDSEC;\n", "a STEP file"),
        "page.dae": (b"\n<!DOCTYPE html><html><body>Not Found</body></html>", "a web page"),
        "empty.stl": (b"", "the file is empty"),
        "blank.obj": (b" \n", "the file is empty"),
        "cut.stl": (stl(4)[:-60], "cut off: it announces 4 triangles and has 2"),
        "cut_text.stl": (b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "cut off: it has no 'endsolid'"),
        "head.stl": (b"\0" * 40, "this is no STL file"),
        "billions.stl": (stl(1, 4_000_000_000), "this is no STL file"),
        "million.stl": (stl(1, 1_000_000), "cut off: it announces 1,000,000 triangles and has 1"),
        **{
            f"garbage{i}.{kind}": (text, f"this is no {name} file: ")
            for i, text in enumerate((b"garbage", b"v 0 0 0\n" * 40))
            for kind, name in {"stl": "STL", "ply": "PLY", "gltf": "glTF", "glb": "GLB", "off": "OFF"}.items()
        },
        "none.stl": (stl(0), "it holds no triangles"),
        "nan.obj": (b"v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "not finite"),
        "huge.obj": (b"v 1e999 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "not finite"),
        "nan.stl": (stl(2)[:96] + struct.pack("<f", float("nan")) + stl(2)[100:], "not finite"),
        "infinite.dae": (collada(numbers="1e999 0 0 1 0 0 0 1 0"), "not finite"),
        "points.ply": (ply(3, 0, b"\0" * 36), "it holds no triangles"),
        "billions.ply": (ply(10**9, 1, b"\0" * 100), "cut off: its header announces"),
        "billions_text.ply": (ply(3, 10**9, b"0 0 0\n", "ascii"), "cut off: its header announces"),
        "sizeless.ply": (
            ply(3, 1, b"\0" * 50, extra="element nothing 1000000000\n"),
            "cut off: its header announces",
        ),
        "negative.ply": (ply(-3, 1, b"\0" * 50), "is no whole number"),
        "headless.ply": (b"ply\nformat ascii 1.0\n", "header is missing"),
        "bomb.zip": (zipped("bomb.obj", big), "an archive"),
        "bomb.stl": (zipped("bomb.obj", big), "an archive"),
        "bomb.zae": (zipped("bomb.dae", big), "an archive"),
        "bomb.3mf": (zipped("3D/3dmodel.model", big), "an archive"),
        "bomb.3dxml": (zipped("bomb.obj", big), "an archive"),
        "bomb.dae": (zipped("bomb.dae", big), "an archive"),
        "behind.dae": (b"<!-- -->" + zipped("bomb.dae", big), "an archive"),
        "bomb.stl.gz": (gzip.compress(big), "an archive"),
        "laughs.dae": (LAUGHS, "document types, entities and external references are refused"),
        "entity.dae": (ENTITY, "document types, entities and external references are refused"),
        "deep.dae": (b"<COLLADA>" + b"<node>" * 5000, "nested more than"),
        "doubled.dae": (doubled(40), "repeats its parts so often"),
        "circle.dae": (collada('<node id="n"><instance_node url="#n"/></node>'), "contains itself"),
        "copies.dae": (
            collada('<node><instance_geometry url="#g"/></node>' * 100_000),
            "repeats its parts so often",
        ),
        "zeros.gltf": (gltf(long), "announces more numbers"),
        "zeros.glb": (_glb(gltf(long)), "announces more numbers"),
        "cut.glb": (_glb(gltf(long))[:40], "cut off"),
        "shared.gltf": (_shared(primitives=1000, nodes=1), "repeats its parts so often"),
        "shared.glb": (_glb(_shared(primitives=1000, nodes=1)), "repeats its parts so often"),
        "many.gltf": (_shared(primitives=1, nodes=1000), "repeats its parts so often"),
        "no.gltf": (b"[" * 100_000, "its JSON cannot be read"),
        "outside.gltf": (
            gltf(
                [{"componentType": 5126, "type": "VEC3", "count": 3, "bufferView": 0}],
                buffers=[{"uri": "../secret.bin", "byteLength": 36}],
            ),
            "secret.bin",
        ),
        "materials.obj": (
            b"\nv 0 0 0" * 200_000 + b"".join(b"\nusemtl m%d\nf 1 2 3" % i for i in range(200_000)),
            "materials for",
        ),
        "scene.usd": (b"#usda 1.0\n", "no .usd files as meshes, but .stl, .obj"),
        "ending": (b"mesh", "no files without an ending"),
    }


def _shared(primitives: int, nodes: int) -> bytes:
    """A glTF file of 10,000 corners, which many primitives or nodes share."""
    corners: dict[str, object] = {"componentType": 5126, "type": "VEC3", "count": 10_000}
    tree = json.loads(gltf([corners], nodes))
    tree["meshes"][0]["primitives"] *= primitives
    return json.dumps(tree).encode()


def _glb(tree: bytes) -> bytes:
    return b"glTF" + struct.pack("<II", 2, 20 + len(tree)) + struct.pack("<I", len(tree)) + b"JSON" + tree


def write(folder: Path) -> dict[str, str]:
    """Write all attacks into a folder; file name → words of the refusal."""
    (folder / "secret.bin").write_bytes(b"\0" * 36)
    meshes = folder / "meshes"
    meshes.mkdir()
    words = {}
    for name, (data, refusal) in attacks().items():
        (meshes / name).write_bytes(data)
        words[name] = refusal
    with open(meshes / "large.stl", "wb") as file:
        file.truncate(3 * 1024**3)
    words["large.stl"] = "larger than 100 MB"
    return words
