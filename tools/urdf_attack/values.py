"""What the attack writes into attributes: numbers, units, names and addresses that a careless reader stumbles over."""

from __future__ import annotations

import re
from random import Random

__all__ = ["ADDRESSES", "DEVOURED", "NUMBERS", "is_numeric", "near_name", "same_number"]

NUMBERS = (
    *("nan", "-NaN", "inf", "-inf", "Infinity", "1e308", "-1e308", "1e309", "1e400", "-1e-400"),
    *("1e-159", "5e-324", "2.2e-308", "1.7976931348623157e308", "1e154", "1e12", "1.0000001e12", "-1e13", "1e6"),
    *("0", "-0", "+.5", "5.", ".", "1e", "e5", "--1", "+-1", "1 e5", "0x10", "0x1p3", "1_000", "1/2", "1*2", "pi"),
    *("１２", "٣", "²", "1,5", "0,5", "1.000,5", "1,000.5", "1;2", "1.0f", "1.0d0", "1.5m", "90deg", "90°", "10mm"),
    *("2rad", "1 m", "true", "None", "", " ", "\t", "\n", "\u00a01", "1\u2009", "\ufeff1", "0" * 500 + "1", "9" * 500),
    *("1." + "3" * 5000, "${x}", "$(arg x)", "NULL", "-", "1e+", "1e99999999999", "3.141592653589793238462643383279"),
)

# The folder of the attack stands for @PACKAGE@, one that no robot may read for @OUTSIDE@ (see sandbox.py).
ADDRESSES = (
    *("file://[", "file://[::1", "file:///[", "file://", "file:", "file:meshes/ok.stl", "file://host/x.stl"),
    *(
        "package://",
        "package:///",
        "package://a//b",
        "package://victim//meshes/ok.stl",
        "package:/victim/meshes/ok.stl",
    ),
    *("package://VICTIM/meshes/ok.stl", "package://../x.stl", "package://victim/../../x.stl", "package://./x.stl"),
    *(
        "package://etc/passwd",
        "package:///etc/passwd",
        "package://proc/self/mem",
        "package://dev/zero",
        "package://[/x",
    ),
    *("package://manifest_fifo/meshes/ok.stl", "package://manifest_zero/meshes/ok.stl", "package://neighbour/ok.stl"),
    *("package://by_manifest/ok.stl", "package://*/meshes/ok.stl", "package://victim/meshes/*.stl", "package://~/x"),
    *("/dev/zero", "/dev/stdin", "/dev/random", "/proc/self/mem", "/proc/self/environ", "/etc/passwd", "/", "//", "."),
    *(
        "file:///dev/zero",
        "file:///proc/self/mem",
        "file:///etc/passwd",
        "file:///%00",
        "file:///%2e%2e/x",
        "FILE:///x",
    ),
    *(
        "@OUTSIDE@/secret.stl",
        "file://@OUTSIDE@/secret.stl",
        "package://@OUTSIDE@/secret.stl",
        "@UP@@OUTSIDE@/secret.stl",
    ),
    *(
        "package://victim/@UP@@OUTSIDE@/secret.stl",
        "package://victim/%2e%2e/%2e%2e/x",
        "meshes/../@UP@@OUTSIDE@/secret.stl",
    ),
    *(
        "..",
        "../..",
        "../../..",
        "../meshes/ok.stl",
        "../../victim/meshes/ok.stl",
        "meshes",
        "meshes/",
        "meshes/ok.stl/",
    ),
    *(
        "../meshes/fifo.stl",
        "../meshes/zero.stl",
        "../meshes/garbage.stl",
        "../meshes/pointer.stl",
        "../meshes/empty.stl",
    ),
    *(
        "../meshes/garbage.dae",
        "../meshes/garbage.obj",
        "../meshes/garbage.ply",
        "../meshes/garbage.glb",
        "../meshes/a.zip",
    ),
    *("../meshes/nan.stl", "../meshes/huge.stl", "../meshes/names_outside.obj", "../meshes/names_outside.dae"),
    *(
        "../meshes/names_outside.gltf",
        "../meshes/bomb.dae",
        "../meshes/bomb.3mf",
        "../meshes/bomb.zip",
        "../meshes/loop.stl",
    ),
    *(
        "\\\\server\\share\\mesh.stl",
        "C:\\robots\\mesh.stl",
        "C:/robots/mesh.stl",
        "..\\meshes\\ok.stl",
        "//server/x.stl",
    ),
    *(
        "http://127.0.0.1:9/x.stl",
        "https://[::1]:9/x.stl",
        "ftp://127.0.0.1/x.stl",
        "data:,x",
        "model://victim/meshes/ok.stl",
    ),
    *("~", "~/x.stl", "~root/x.stl", "~nobody_at_all/x.stl", "$HOME/x.stl", "$(find victim)/meshes/ok.stl", "${x}"),
    *("", " ", " ../meshes/ok.stl ", "../meshes/ok.stl?a#b", "../meshes/OK.STL", "ok\u0000.stl", "\ud7ff", "x" * 5000),
    *("a/" * 3000 + "x.stl", "../" * 3000 + "x.stl", "package://" + "a" * 300 + "/x.stl", "\n", "a\nb.stl", "é.stl"),
)

# Characters that some readers drop and others choke on, for the inside of names.
DEVOURED = (
    "\u00a0",
    "\u200b",
    "\t",
    "\n",
    "\r",
    "\u0085",
    "\u2028",
    "\u202e",
    "\ufffe",
    "\U0001f916",
    "é",
    "&",
    "<",
    '"',
    "'",
)


NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)


def is_numeric(text: str) -> bool:
    """Whether an attribute holds plain numbers, at least one."""
    words = text.split()
    return bool(words) and all(NUMBER.fullmatch(word) for word in words)


def near_name(random: Random, name: str) -> str:
    """A name that is easily taken for this one, or one that is hard to take at all."""
    place = random.randrange(len(name) + 1)
    match random.randrange(9):
        case 0:
            return name.upper() if name != name.upper() else name.lower()
        case 1:
            return name[:1].swapcase() + name[1:]
        case 2:
            return name[:place] + name[place + 1 :]
        case 3:
            return name[:place] + name[place : place + 2][::-1] + name[place + 2 :]
        case 4:
            return name + random.choice(("s", "_", " ", "er", "0"))
        case 5:
            return random.choice((" ", "\t", "")) + name + random.choice((" ", "\n", ""))
        case 6:
            return name[:place] + random.choice(DEVOURED) + name[place:]
        case 7:
            return random.choice(
                ("", " ", "universe", "root_joint", "world", "..", "a:b", "%s", "{0}", "nan", "0", "-")
            )
        case _:
            return name * random.choice((2, 40, 2000))


def same_number(random: Random, text: str) -> str:
    """The numbers of an attribute in another notation that has one plausible reading."""
    words = text.split()
    match random.randrange(6):
        case 0 if len(words) > 1:
            return random.choice((", ", ",", " , ", ",  ")).join(words)
        case 1 if len(words) > 1:
            return ",".join(words) + ","
        case 2:
            return random.choice((" ", "\n\t", "\u00a0", "\ufeff")) + text + random.choice((" ", "\u00a0", "\n"))
        case 3:
            return " ".join(word + "f" for word in words)
        case 4:
            return " ".join(repr(float(word)) for word in words)
        case _:
            return random.choice(("  ", "\t", "\n", "\r\n")).join(f"{float(word):+.17e}" for word in words)
