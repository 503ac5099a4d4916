"""What is wrong with an in-between, where and how badly: the certificate of a span."""

from core.certificate.certify import Certificate, certify, certify_drawing
from core.certificate.problems import SEVERITIES, Problem

__all__ = ["SEVERITIES", "Certificate", "Problem", "certify", "certify_drawing"]
