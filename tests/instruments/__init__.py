"""Files as instruments write them, made from the formats' descriptions: no file of anybody is copied."""
