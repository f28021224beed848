"""Tests of the reference devices and masters, without a network or kernel CAN."""
