"""`python -m pinik` is the `pinik` command."""

import sys

from .cli import main

if __name__ == "__main__":
    sys.exit(main())
