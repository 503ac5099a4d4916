"""The editor and the command line; the engine is the package `core`."""

__version__ = "0.1.0"
