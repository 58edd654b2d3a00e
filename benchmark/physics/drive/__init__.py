"""Effects of the rig, which gives the tissue another depth than it reports: one file each."""
