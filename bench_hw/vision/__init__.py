"""From pictures to displacements: camera, calibration, frames, markers, tracking, displacement.

`camera` is the optical model, without any picture; `calibration` finds it from pictures of a board; `frames`
gives the pictures of a trial or video one after the other; `markers` finds markers in one picture; `tracking` follows
them from picture to picture; `displacement` turns tracks into what the rest of the product compares.
Nothing is imported here: take what is needed from the rooms.
"""
