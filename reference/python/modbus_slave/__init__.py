"""A Modbus slave on pymodbus: what that library does, and small additions where it does less."""
