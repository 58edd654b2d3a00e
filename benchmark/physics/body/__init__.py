"""Effects of the tissue, its layers and the contact: one file each."""
