"""Tables of rows: what drivers have in mind, what units hold, what lies on the street."""
