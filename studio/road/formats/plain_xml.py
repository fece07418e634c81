"""XML of anybody, read without what makes it dangerous: no document type, so no entities and nothing from elsewhere."""

from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from studio.errors import MapError


def parse(data: bytes, what: str) -> Element:
    """The root element of XML without document type and entities; namespaces are left out. `what` is what messages call the file.

    Raises:
        MapError: the text is empty, cut off, no XML, or tries more than plain elements.
    """
    if not data.strip():
        raise MapError(f"the {what} is empty")
    builder, reader = TreeBuilder(), expat.ParserCreate()
    reader.StartElementHandler = lambda name, attributes: builder.start(name.rpartition(":")[2], attributes)
    reader.EndElementHandler = lambda name: builder.end(name.rpartition(":")[2])
    reader.CharacterDataHandler = builder.data
    reader.StartDoctypeDeclHandler = refuse_doctype
    try:
        reader.Parse(data, True)
        return builder.close()
    except (LookupError, ValueError) as error:
        raise MapError(f"this is not XML in an encoding that can be read ({error})") from None
    except expat.ExpatError as error:
        told = expat.errors.messages[error.code]
        raise MapError(f"line {error.lineno}: this is not XML, or it is cut off ({told}); fetch it again") from None


def refuse_doctype(*_) -> None:
    """Entities are declared in a document type."""
    raise MapError("XML with a document type or entities is refused; export it again without them")
