"""The editor and the command line; the engine is the package `core`."""
