"""`verify`: every case of the models against published values and closed forms, as table, files and page."""
