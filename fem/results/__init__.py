"""What a run gives as plain arrays."""
