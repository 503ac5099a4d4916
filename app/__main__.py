"""`python -m app` is `inkbetween`."""

import sys

from app.cli import main

sys.exit(main())
