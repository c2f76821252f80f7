"""The pictures of docs/architecture.md: what is committed is what the tools draw from today's source."""

from __future__ import annotations

import draw_rooms
import draw_solve


def test_the_picture_of_the_rooms_shows_todays_imports():
    drawn = str(draw_rooms.drawing())
    assert draw_rooms.PICTURE.read_text("utf-8") == drawn, "python tools/draw_rooms.py draws it anew"


def test_the_picture_of_a_solve_is_what_its_tool_draws():
    drawn = str(draw_solve.drawing())
    assert draw_solve.PICTURE.read_text("utf-8") == drawn, "python tools/draw_solve.py draws it anew"


def test_rooms_and_imports_are_read_as_they_are():
    words, room_of = draw_rooms.rooms()
    assert next(iter(words)) == draw_rooms.GROUND
    assert room_of["errors"] == draw_rooms.GROUND
    assert room_of["solving.run"] == room_of["solving.native.codec"] == "solving"
    assert room_of["viewer.web.server"] == "viewer/web"
    assert room_of["viewer.live"] == "viewer/live"
    found = set(draw_rooms.imports(set(room_of)))
    assert ("picture.render", "picture.bodies") in found
    assert ("viewer.web.server", "viewer.web.scene") in found
    assert ("shapes.known", "shapes.meshes") in found  # inside a function
    assert ("__main__", "cli") in found
    assert not any(imported.startswith("cli") for name, imported in found if not name.startswith(("cli", "__main__")))
