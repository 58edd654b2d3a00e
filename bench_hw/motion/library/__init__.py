"""The shipped protocols of motion, a TOML file each."""
