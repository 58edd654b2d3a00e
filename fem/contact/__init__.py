"""Contacts between tool and surface, one a file."""

from fem.contact.conditions import Conditions, ContactModel, Resolution
from fem.contact.registry import CONTACT_MODELS

__all__ = ["CONTACT_MODELS", "Conditions", "ContactModel", "Resolution"]
