"""OpenDRIVE (ASAM OpenDRIVE 1.4 to 1.8): the document, read element by element, and the network that it makes.

One flawed element costs that element: where what is meant is safe to say it is derived and noted as a guess, else the element is left
out and told with its place. Only a document without a usable road is refused.
"""
