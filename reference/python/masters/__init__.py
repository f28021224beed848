"""python-canopen and pymodbus as masters, to check a device with."""
