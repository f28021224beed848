"""What a device does beyond its dictionary: nothing, unless a device says otherwise."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .node import Node


class Behaviour:
    """The default of every device."""

    # Whether bit 30 of 1005h may be set.
    produces_sync = False
    # Whether LSS is answered.
    has_lss = False
    # Indices whose values survive a reset without being stored.
    saved_by_itself: frozenset[int] = frozenset()

    def booted(self, node: "Node") -> None:
        """The dictionary has its values, and the boot-up message comes next."""

    def check(self, node: "Node", index: int, sub_index: int, value: int) -> None:
        """Refuses a value that comes from the bus."""

    def written(self, node: "Node", index: int, sub_index: int, value: int) -> None:
        """A value was written from the bus."""
