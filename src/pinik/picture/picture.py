"""A drawn picture: its pixels, its camera, and the files it can be written to."""

from __future__ import annotations

import io
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import as_file_name
from ..errors import InputError
from ..extras import needed_by
from ..files import write_whole
from .arguments import SMALLEST, as_any_points, depth_of
from .camera import Camera

if TYPE_CHECKING:
    from PIL.Image import Image

__all__ = ["Picture"]

Array = NDArray[np.float64]

_WITH_OPACITY = ("AVIF", "DDS", "ICNS", "ICO", "JPEG2000", "PNG", "QOI", "SGI", "TGA", "TIFF", "WEBP")


@dataclass(frozen=True, eq=False)
class Picture:
    """A drawn picture. A notebook shows it by itself; for matplotlib use `axes.imshow(picture.pixels)`.

    Attributes:
        pixels: Red, green, blue and opacity (h, w, 4), 0..255.
        camera: The camera that saw it; `draw(..., view=picture.camera)` draws another picture from the same place.
    """

    pixels: NDArray[np.uint8]
    camera: Camera

    @property
    def size(self) -> tuple[int, int]:
        """Width and height [pixels]."""
        height, width = self.pixels.shape[:2]
        return width, height

    def project(self, points: ArrayLike) -> Array:
        """Project points of the robot's world onto the picture, to label them.

        Args:
            points: (3,) or (n, 3) [m].

        Returns:
            Pixels from the left and from the top, (2,) or (n, 2), as `axes.imshow` counts them; NaN for a point behind
            the camera.
        """
        single = depth_of(points) == 1
        x, y, depth = self.camera.seen(as_any_points(points, "points"), self.size).T
        depth = np.where(depth > 0.0, depth, np.nan)
        found = np.stack([x / depth, y / depth], axis=1) - 0.5
        return np.asarray(found[0] if single else found)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the picture to a file, whole or not at all; the suffix, such as .png or .jpg, gives the format.

        A format without opacity gets a white background.

        Raises:
            InputError: Pillow writes no format with this suffix.
            OSError: The file cannot be written.
        """
        with needed_by("a picture's file", "pictures"):
            from PIL import Image

        file_name = as_file_name(path, "path", "robot.png")
        kind = Image.registered_extensions().get(file_name.suffix.lower(), "")
        image = Image.fromarray(self.pixels)
        if kind not in _WITH_OPACITY:
            image = Image.alpha_composite(Image.new("RGBA", image.size, "white"), image).convert("RGB")
        if not _is_written(image, kind):
            raise InputError(
                f"path must end in .png, .jpg or another suffix that Pillow can write; got {str(file_name)!r}"
            )
        file = io.BytesIO()
        image.save(file, kind)
        write_whole(path, file.getvalue())

    def png(self, colors: int | None = None) -> bytes:
        """The bytes of a PNG file.

        Args:
            colors: How many different colours it may have, 2 to 256, which halves its size; all of them when None.
        """
        with needed_by("a picture's file", "pictures"):
            from PIL import Image

        opaque = bool((self.pixels[..., 3] == 255).all())
        image = Image.fromarray(self.pixels[..., :3] if opaque else self.pixels)
        if colors is not None:
            if type(colors) is not int or not 2 <= colors <= 256:
                raise InputError(f"colors must be a whole number from 2 to 256, or None; got {colors!r}")
            image = image.quantize(colors, Image.Quantize.MEDIANCUT if opaque else Image.Quantize.FASTOCTREE)
        file = io.BytesIO()
        image.save(file, "png", optimize=True)
        return file.getvalue()

    def _repr_png_(self) -> bytes:
        """What a notebook shows."""
        return self.png()

    def __repr__(self) -> str:
        return f"<Picture of {self.size[0]}×{self.size[1]} pixels>"


def _is_written(image: Image, kind: str) -> bool:
    """Whether Pillow can write this format, found by writing a corner of the picture."""
    try:
        image.crop((0, 0, SMALLEST, SMALLEST)).save(io.BytesIO(), kind)
    except (KeyError, OSError, ValueError):
        return False
    return True
