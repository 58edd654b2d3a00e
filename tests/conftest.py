"""What all tests share: drawn examples are never timed, since the machine may be busy; nothing is kept for later."""

import os

from hypothesis import settings

settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")
os.environ["TISSUEBENCH_CACHE"] = ""
