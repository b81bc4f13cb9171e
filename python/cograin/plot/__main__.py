"""``python -m cograin.plot``."""

import sys

from cograin.plot.command import main

if __name__ == "__main__":
    sys.exit(main())
