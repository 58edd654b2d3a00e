"""Trial sessions from their folders: trials with tool and support, what is known of the rig, what had to be assumed.

How one trial's table is parsed is `bench_hw.tables`; what is fitted to a session is not decided here.
"""
