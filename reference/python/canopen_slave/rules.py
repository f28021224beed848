"""What any download must keep to: access, length and limits of its entry in the EDS."""

from canopen.objectdictionary import INTEGER_TYPES, ODVariable

from . import abort


def check_access(entry: ODVariable) -> None:
    """Refuses an entry that may not be written."""
    if not entry.writable:
        abort.refuse(abort.READ_ONLY)


def check_length(entry: ODVariable, size: int) -> None:
    """Refuses `size` bytes for a number of another length."""
    if entry.data_type not in INTEGER_TYPES:
        return
    length = len(entry) // 8
    if size > length:
        abort.refuse(abort.TOO_LONG)
    if size < length:
        abort.refuse(abort.TOO_SHORT)


def check_limits(entry: ODVariable, data: bytes) -> None:
    """Refuses a number outside LowLimit and HighLimit."""
    if entry.data_type not in INTEGER_TYPES:
        return
    value = entry.decode_raw(data)
    if entry.max is not None and value > entry.max:
        abort.refuse(abort.TOO_HIGH)
    if entry.min is not None and value < entry.min:
        abort.refuse(abort.TOO_LOW)
