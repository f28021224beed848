"""Compares how our reader and python-canopen understand EDS files, entry by entry.

    compare_eds.py DUMP FILE...

DUMP is a program that prints what our reader makes of the EDS on its standard input (the example `dump_eds`). A
misreading that the reader and the reference devices share would hide everywhere else; python-canopen shares nothing
with either. Prints every difference and exits with 1 if there is one.
"""

import subprocess
import sys

import canopen
from canopen.objectdictionary import ODArray, ODRecord, ODVariable

# That of the dump.
NODE = 5
# python-canopen makes an object of each data type that [DummyUsage] allows; these have no sections.
LAST_DUMMY = 0x1F
# python-canopen reads no limits of INTEGER24, INTEGER40, INTEGER48 and INTEGER56.
WITHOUT_LIMITS = (0x10, 0x12, 0x13, 0x14)


def theirs(path):
    """{(index, sub): (type, access, mappable, low, high, default)} as python-canopen reads the file."""
    entries = {}
    for thing in canopen.import_od(path, node_id=NODE).values():
        if thing.index <= LAST_DUMMY:
            continue
        if isinstance(thing, ODVariable):
            variables = {0: thing}
        elif isinstance(thing, (ODRecord, ODArray)):
            variables = thing.subindices
        for sub, variable in variables.items():
            entries[(thing.index, sub)] = (
                variable.data_type,
                variable.access_type,
                bool(variable.pdo_mappable),
                variable.min,
                variable.max,
                default(variable),
            )
    return entries


def default(variable):
    """The default as bytes, or None."""
    value = variable.default
    if value is None or value == "":
        return None
    return variable.encode_raw(value)


def ours(dump, path):
    """The same as our reader reads it."""
    with open(path, "rb") as file:
        lines = subprocess.run([dump], stdin=file, capture_output=True, check=True).stdout
    entries = {}
    for line in lines.decode().splitlines():
        index, sub, data_type, access, mappable, low, high, value = line.split(" ")
        entries[(int(index, 16), int(sub, 16))] = (
            int(data_type, 16),
            access,
            mappable == "1",
            None if low == "-" else int(low),
            None if high == "-" else int(high),
            None if value == "-" else bytes.fromhex(value),
        )
    return entries


def main():
    dump, *paths = sys.argv[1:]
    names = ("type", "access", "mappable", "low limit", "high limit", "default")
    differences = compared = 0
    for path in paths:
        left, right = ours(dump, path), theirs(path)
        for key in sorted(left.keys() | right.keys()):
            compared += 1
            where = f"{path}: {key[0]:04X}h:{key[1]:02X}"
            if key not in left or key not in right:
                differences += 1
                print(f"{where} only {'python-canopen' if key in right else 'our reader'} has it")
                continue
            for name, mine, other in zip(names, left[key], right[key]):
                unread = name.endswith("limit") and left[key][0] in WITHOUT_LIMITS and other is None
                if mine != other and not unread:
                    differences += 1
                    print(f"{where} {name}: ours {mine!r}, python-canopen {other!r}")
    print(f"{compared} entries of {len(paths)} files compared, {differences} differences")
    return 1 if differences or not compared else 0


if __name__ == "__main__":
    sys.exit(main())
