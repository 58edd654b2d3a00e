"""Recording trials: every device in step on one clock, safety watched, one file a trial, one session a folder.

`order` is what is asked for, `loop` turns the devices, `trial` records one trial and ends it safely, `session` makes a
folder of them, `progress` shows what goes on.
"""
