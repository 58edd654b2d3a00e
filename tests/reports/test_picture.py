"""A picture that no lines can draw stands in the page as data."""

import base64

from reports import Figure, Page, Picture, Section, Verdict, render_page

PNG = b"\x89PNG\r\nbytes"


def test_a_picture_is_part_of_the_page():
    figure = Figure((Picture(PNG, 'a "pressed" <body>'),), "what is seen", "Body")
    page = render_page(Page(title="t", verdict=Verdict("good", "fine"), sections=[Section("S", [figure])]))
    assert f'src="data:image/png;base64,{base64.b64encode(PNG).decode()}"' in page
    assert 'alt="a &#34;pressed&#34; &lt;body&gt;"' in page
