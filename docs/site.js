"use strict";
// Wide tables scroll inside the page, and the keyboard reaches what scrolls.
document.querySelectorAll(".col-md-9 table").forEach((table, place) => {
  const scroller = document.createElement("div");
  scroller.className = "scroll";
  scroller.tabIndex = 0;
  scroller.setAttribute("role", "group");
  scroller.setAttribute("aria-label", "Table " + (place + 1));
  table.before(scroller);
  scroller.append(table);
});
document.querySelectorAll("pre").forEach((listing) => (listing.tabIndex = 0));
