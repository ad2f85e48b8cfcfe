"""Tokens: ours pass, everything else does not."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from server.auth import Tokens, new_token


@given(offered=st.text())
def test_only_our_tokens_pass(offered: str) -> None:
    tokens = Tokens(["one", "two"])
    assert tokens.allows(offered) is (offered in ("one", "two"))
    assert tokens.allows_header(offered) is False
    assert tokens.allows_header("Bearer one")
    assert tokens.allows_header("bearer two ")
    assert not tokens.allows(None)
    assert not tokens.allows_header(None)


def test_new_tokens_differ_and_empty_ones_are_a_mistake() -> None:
    assert new_token() != new_token()
    with pytest.raises(ValueError, match="empty"):
        Tokens([""])
