"""What every test needs: a Qt that asks for no display, and property tests that no busy machine can fail."""

import os

from hypothesis import settings

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

settings.register_profile("inkbetween", deadline=None)
settings.load_profile("inkbetween")
