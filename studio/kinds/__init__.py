"""The kinds that come with the studio. They enter by the door that users' kinds enter by: nothing else in the studio imports them."""
