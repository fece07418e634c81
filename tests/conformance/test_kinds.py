"""Every kind that comes with the studio keeps what `studio conform` demands of others."""

import pytest

from studio.kind import registry
from studio.workshop.conform import conform

BUILT_IN = [kind for kind in registry.every() if kind.is_built_in]


@pytest.mark.parametrize("kind", BUILT_IN, ids=lambda kind: f"{kind.sort}.{kind.name}")
def test_it_conforms(kind):
    assert [str(check) for check in conform(kind) if check.wrong] == []
