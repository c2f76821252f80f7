"""The viewer's tests use a shape cache of their own."""

from __future__ import annotations

import pytest

from page_fixtures import browser, open_desk, open_panel, open_stage, tabs  # noqa: F401


@pytest.fixture(scope="session", autouse=True)
def _own_shape_cache(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PINIK_CACHE_DIR", str(tmp_path_factory.mktemp("cache")))
        yield
