"""The document: immutable values with shared parts, and the edits that make a new one from an old one."""
