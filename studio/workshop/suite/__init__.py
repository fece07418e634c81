"""What kinds of a sort must keep besides the parts of their contract: a file for each sort, with `checks(kind)`."""
