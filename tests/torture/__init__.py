"""The program in bad hands and on bad days: kills, full disks, odd places, malformed files. `make test-torture`."""
