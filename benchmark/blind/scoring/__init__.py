"""What the answers of a blind run are worth: cases judged, measures with their intervals and bars."""
