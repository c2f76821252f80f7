"""Refuse mesh files in words, before trimesh reads them: other files, cut-off ones, and small ones that become huge.

pinik reads STL, OBJ, COLLADA (.dae), PLY, glTF (.gltf, .glb) and OFF files. It opens no archives.
"""

from __future__ import annotations

import io
import json
import re
import struct
import zipfile
from collections import Counter
from typing import Any, Literal, get_args

from ..description.edits import start_tag
from ..description.encodings import as_utf_8
from ..description.xml import BrokenXMLError, DocumentError, Element, parse
from ..echoes import QUOTED, shortened

__all__ = ["FORMATS", "MOST_BYTES", "NOT_FINITE", "UNDRAWN", "MeshError", "UndrawnCode", "checked"]

UndrawnCode = Literal[
    "unreadable-shape",
    "unreadable-mesh",
    "lfs-pointer",
    "not-a-mesh",
    "truncated-mesh",
    "empty-mesh",
    "nan-in-mesh",
    "mesh-too-large",
    "mesh-archive",
    "unknown-mesh-format",
]
UNDRAWN: tuple[UndrawnCode, ...] = get_args(UndrawnCode)
"""The codes of flaws for shapes that are there and cannot be drawn."""

FORMATS = ("stl", "obj", "dae", "ply", "gltf", "glb", "off")
MOST_BYTES = 100 * 1024**2
"""The largest mesh file that is read."""
_MOST_COPIED = 5 * MOST_BYTES  # bytes that a COLLADA file may repeat, in all
_MOST_WALKED = 1_000_000_000  # vertices times materials of an OBJ file
_MOST_ENTRIES = 25_000_000  # of the arrays of a glTF file, in all
_MOST_REPEATED = 8_000_000  # corners and triangles of a glTF file that are used once more; each costs up to 200 bytes
_REPEATS = "it repeats its parts so often that it would become far larger than it is"
_ARCHIVES = (
    b"PK\x03\x04",
    b"PK\x05\x06",
    b"\x1f\x8b",
    b"BZh",
    b"\xfd7zXZ",
    b"7z\xbc\xaf",
    b"\x28\xb5\x2f\xfd",
    b"Rar!",
)
_PLY_SIZES = {"char": 1, "uchar": 1, "short": 2, "ushort": 2, "int": 4, "uint": 4, "float": 4, "double": 8}
_PLY_ELEMENT = re.compile(rb"^[ \t]*element[ \t]+(\S+)[ \t]+(\S+)", re.MULTILINE)


_NOT_FINITE = re.compile(rb"[nN#]")  # in numbers: as in "nan", "inf" and "-1.#IND"

NOT_FINITE = "it has corners that are not finite numbers (NaN or infinite)"
"""What is wrong with a mesh whose code is "nan-in-mesh"."""


class MeshError(ValueError):
    """A mesh file cannot be used.

    Attributes:
        code: The sort of fault, as the code of a flaw.
    """

    def __init__(self, message: str, code: UndrawnCode = "unreadable-mesh") -> None:
        self.code = code
        super().__init__(message)


def checked(data: bytes, kind: str) -> bytes:
    """The contents of a mesh file, without what follows the last triangle of a binary STL file.

    Args:
        data: The contents.
        kind: The file's ending without its dot, in lower case.

    Raises:
        MeshError: The file is no mesh of a known format, it is cut off, or it would become far larger than it is.
    """
    _refuse_other_files(data)
    if kind not in FORMATS:
        known = ", ".join(f".{one}" for one in FORMATS)
        what = f"no .{kind} files" if kind else "no files without an ending"
        raise MeshError(f"pinik reads {what} as meshes, but {known}", "unknown-mesh-format")
    match kind:
        case "stl":
            return _checked_stl(data)
        case "ply":
            _check_ply(data)
        case "obj":
            _check_obj(data)
        case "dae":
            _check_collada(data)
        case "glb" | "gltf":
            _check_gltf(data, kind)
        case "off":
            if b"OFF" not in data:
                raise MeshError("this is no OFF file: its header is missing", "not-a-mesh")
    return data


def _refuse_other_files(data: bytes) -> None:
    start = data[:400].lstrip(b"\xef\xbb\xbf \t\r\n")
    if not start:
        raise MeshError("the file is empty", "empty-mesh")
    if start.startswith(b"version https://git-lfs.github.com/spec"):
        cause = "this is a Git LFS pointer and not the mesh itself; 'git lfs pull' in its repository fetches the mesh"
        raise MeshError(cause, "lfs-pointer")
    if start.startswith(b"ISO-10303-21"):
        raise MeshError("this is a STEP file (CAD), not a mesh; export it as STL, OBJ or DAE", "not-a-mesh")
    if start.startswith(_ARCHIVES):
        raise MeshError("this is an archive, and pinik unpacks none; unpack the mesh beside the URDF", "mesh-archive")
    if re.match(rb"<!doctype\s+html|<html", start, re.IGNORECASE):
        raise MeshError("this is a web page, perhaps saved in place of the mesh", "not-a-mesh")


def _checked_stl(data: bytes) -> bytes:
    announced = struct.unpack_from("<I", data, 80)[0] if len(data) >= 84 else 0
    needed = 84 + 50 * announced
    if data.lstrip()[:5].lower() == b"solid" and needed != len(data):
        if b"endsolid" not in data.lower():
            raise MeshError("the file is cut off: it has no 'endsolid'", "truncated-mesh")
        return data
    if len(data) < 84 or len(data) < MOST_BYTES < needed:
        raise MeshError("this is no STL file: its header is missing or cut off", "not-a-mesh")
    if len(data) < needed:
        held = (len(data) - 84) // 50
        raise MeshError(f"the file is cut off: it announces {announced:,} triangles and has {held:,}", "truncated-mesh")
    return data[:needed]


def _check_ply(data: bytes) -> None:
    """Compare the counts in the header with what can stand in the file."""
    header, end, body = data.partition(b"end_header")
    if not header.lstrip().startswith(b"ply") or not end:
        code: UndrawnCode = "truncated-mesh" if data.lstrip().startswith(b"ply") else "not-a-mesh"
        raise MeshError("this is no PLY file: its header is missing or cut off", code)
    binary = b"format binary" in header
    needed = 0
    sections = _PLY_ELEMENT.split(header)[1:]
    for name, count, properties in zip(sections[::3], sections[1::3], sections[2::3], strict=True):
        if not count.isdigit() or len(count) > 12:
            of = shortened(name.decode(errors="replace"), QUOTED)
            raise MeshError(f"its number of {of} elements is no whole number")
        words = [line.split() for line in properties.splitlines() if line.strip().startswith(b"property")]
        sizes = [_PLY_SIZES.get(line[1].decode("ascii", "replace"), 1) for line in words if len(line) > 1]
        needed += int(count) * max(sum(sizes) if binary else len(words), 1)
    if needed > len(body):
        cause = f"the file is cut off: its header announces at least {needed:,} bytes, and {len(body):,} follow"
        raise MeshError(cause, "truncated-mesh")


def _check_obj(data: bytes) -> None:
    """Each material costs trimesh a walk through all vertices."""
    materials = len(set(re.findall(rb"^usemtl[^\n]*", data, re.MULTILINE)))
    vertices = data.count(b"\nv ")
    if materials * vertices > _MOST_WALKED:
        raise MeshError(f"{materials:,} materials for {vertices:,} vertices are too many", "mesh-too-large")


def _check_gltf(data: bytes, kind: str) -> None:
    """Bound the lengths of arrays, as those that are announced without data are filled with zeros, and their copies."""
    text = data
    if kind == "glb":
        if data[:4] != b"glTF" or len(data) < 20:
            code: UndrawnCode = "truncated-mesh" if data.startswith(b"glTF") else "not-a-mesh"
            raise MeshError("this is no GLB file: its header is missing or cut off", code)
        announced, length = struct.unpack_from("<I", data, 8)[0], struct.unpack_from("<I", data, 12)[0]
        if announced > len(data):
            cause = f"the file is cut off: it announces {announced:,} bytes and has {len(data):,}"
            raise MeshError(cause, "truncated-mesh")
        text = data[20 : 20 + length]
    try:
        tree: Any = json.loads(text)
        counts = [int(accessor["count"]) for accessor in tree.get("accessors", [])]
        repeated = _repeated(tree, counts)
    except (ValueError, LookupError, TypeError, AttributeError, OverflowError, RecursionError):
        raise MeshError("this is no glTF file: its JSON cannot be read", "not-a-mesh") from None
    if min(counts, default=0) < 0 or sum(counts) > _MOST_ENTRIES:
        raise MeshError("it announces more numbers than pinik reads", "mesh-too-large")
    if repeated > _MOST_REPEATED:
        raise MeshError(_REPEATS, "mesh-too-large")


def _repeated(tree: Any, counts: list[int]) -> int:
    """How many corners and triangles of a glTF file are copies: of arrays that primitives share, and for more nodes."""
    shown = Counter(node.get("mesh") for node in tree.get("nodes", []))
    total, known = 0, set()
    for number, mesh in enumerate(tree.get("meshes", [])):
        for primitive in mesh["primitives"]:
            corners = max(primitive["attributes"].values(), key=counts.__getitem__, default=None)
            for array, entries in ((corners, 1), (primitive.get("indices"), 3)):  # for a corner, and for a triangle
                if array is not None:
                    total += counts[array] // entries * (max(shown[number], 1) - (array not in known))
                    known.add(array)
    return total


def _check_collada(data: bytes) -> None:
    """Read the XML safely, and count how often parts are repeated: nodes that repeat nodes can make billions."""
    if zipfile.is_zipfile(io.BytesIO(data)):
        raise MeshError("this is an archive, and pinik unpacks none", "mesh-archive")
    try:
        data = as_utf_8(data)
        root = parse(data, most_bytes=MOST_BYTES)
    except DocumentError as fault:
        # The message of broken XML names line and column itself.
        where = f" (line {fault.line})" if fault.line and not isinstance(fault, BrokenXMLError) else ""
        raise MeshError(f"{fault.message}{where}") from None
    _refuse_nan(root, data)
    nodes = {node.attributes.get("id"): node for node in root.walk() if node.tag.rpartition(":")[2] == "node"}
    counts: dict[int, int] = {}
    scenes = [element for element in root.walk() if element.tag.rpartition(":")[2] == "visual_scene"]
    total = sum(_instances(scene, nodes, counts, set()) for scene in scenes)
    used = Counter(
        element.attributes.get("url")
        for element in root.walk()
        if element.tag.rpartition(":")[2] in ("instance_geometry", "instance_controller")
    )
    if (total - len(used)) * len(data) > _MOST_COPIED:
        raise MeshError(_REPEATS, "mesh-too-large")


def _refuse_nan(root: Element, data: bytes) -> None:
    """Refuse positions that are not finite, as pycollada reads NaN as 0."""
    sources = {
        one.attributes.get("source", "").removeprefix("#")
        for one in root.walk()
        if one.tag.rpartition(":")[2] == "input" and one.attributes.get("semantic") == "POSITION"
    }
    for source in (one for one in root.walk() if one.attributes.get("id") in sources):
        for array in (child for child in source.children if child.tag.rpartition(":")[2] == "float_array"):
            begins = start_tag(data, array).end
            if _NOT_FINITE.search(data, begins, max(data.find(b"<", begins), begins)):
                raise MeshError(NOT_FINITE, "nan-in-mesh")


def _instances(element: Element, nodes: dict[str | None, Element], counts: dict[int, int], above: set[int]) -> int:
    """How many shapes an element of a COLLADA scene becomes."""
    if id(element) in counts:
        return counts[id(element)]
    if id(element) in above:
        raise MeshError("a node of its scene contains itself")
    count = 0
    for child in element.children:
        match child.tag.rpartition(":")[2]:
            case "instance_geometry" | "instance_controller":
                count += 1
            case "instance_node":
                target = nodes.get(child.attributes.get("url", "").removeprefix("#"))
                if target is not None:
                    count += _instances(target, nodes, counts, above | {id(element)})
            case "node":
                count += _instances(child, nodes, counts, above | {id(element)})
    counts[id(element)] = count
    return count
