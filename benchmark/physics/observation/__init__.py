"""Effects of the sensors and the camera, which report something else than happened: one file each."""
