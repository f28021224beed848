"""A CANopen slave on python-can and canopen: what those libraries do, and small additions where they do less."""
