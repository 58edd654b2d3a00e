"""What all tests share: drawn examples are the same on every run and never timed, and nothing is kept for later.

`pytest --hypothesis-profile=search` draws new examples on each run; `--hypothesis-seed` draws those of one run again.
"""

import os

from hypothesis import HealthCheck, settings

settings.register_profile(
    "same_each_run", deadline=None, derandomize=True, database=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("search", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("same_each_run")
os.environ["TISSUEBENCH_CACHE"] = ""
