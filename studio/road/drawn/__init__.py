"""Maps that the studio draws: a town, a parking deck, a motorway."""
