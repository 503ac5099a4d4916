"""What every test needs: a Qt that asks for no display, and property tests that no busy machine can fail."""

import os

from hypothesis import settings

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

# before a change lands the examples are the same every time: a red run tells of the change; elsewhere they are new
settings.register_profile("inkbetween", deadline=None, derandomize="CI" in os.environ)
settings.load_profile("inkbetween")
