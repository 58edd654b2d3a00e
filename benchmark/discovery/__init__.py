"""Discovery: where simulation and measured trials disagree, which effect is missing, how much of the gap it closes."""
