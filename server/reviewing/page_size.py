"""How large a walk's page may be, in megabytes; apart from the making, which loads much that no other command needs."""

from typing import Final

DEFAULT_MB: Final = 40
SMALLEST_MB: Final = 8
LARGEST_MB: Final = 400
