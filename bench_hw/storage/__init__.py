"""Files on disk: read only where they are regular and of bounded size, written whole or not at all, folders locked."""
