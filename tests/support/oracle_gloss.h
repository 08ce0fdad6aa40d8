/* SPDX-License-Identifier: MIT
 * Facets of gloss: the terms of GGX that quadratures of its lobe share. All cosines are above 0. */
#ifndef SDFGI_TESTS_ORACLE_GLOSS_H
#define SDFGI_TESTS_ORACLE_GLOSS_H

/* Schlick's Fresnel term. */
double oracle_fresnel(double f0, double cosine);

/* Share of facets that neither the viewer's side nor the light's hides, for their cosines to the normal:
 * height-correlated Smith term. For a light along the normal it is what the viewer sees. */
double oracle_smith(double viewer, double light, double alpha);

#endif
