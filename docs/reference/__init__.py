"""Pages of the reference that are made from the code: each module here makes one page, by `page()`."""
