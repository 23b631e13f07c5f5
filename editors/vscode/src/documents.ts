// The documents that btq is for: missions, and XML that is BehaviorTree.CPP's.  There is much other XML.
// One invariant: XML is recognized by its text alone, as the server does (btq_lang/btcpp/recognition.py).
import * as vscode from "vscode";

const SCHEMES = ["file", "untitled"];

/** What the server receives once it runs; it is silent about other XML. */
export const SELECTOR = ["btq", "xml"].flatMap((language) => SCHEMES.map((scheme) => ({ scheme, language })));

/** Whether a document is in the language, or is XML of BehaviorTree.CPP. */
export function isOurs(document: vscode.TextDocument | undefined): document is vscode.TextDocument {
  return document?.languageId === "btq" || isTrees(document);
}

/** Whether a document is XML of BehaviorTree.CPP. */
export function isTrees(document: vscode.TextDocument | undefined): document is vscode.TextDocument {
  if (document?.languageId !== "xml" || !SCHEMES.includes(document.uri.scheme)) return false;
  const text = document.getText();
  return ROOT.test(text.slice(PROLOG.exec(text)?.[0].length));
}

const PROLOG = /^(?:[^<]+|<\?.*?\?>|<!--.*?-->|<!(?!--)[^>]*>)*/s;
const ROOT =
  /^<root(?=[\s/>])(?:[^>]*\s(?:BTCPP_format|main_tree_to_execute)\s*=|.*?<(?:BehaviorTree\b|TreeNodesModel\b|include\s[^>]*\bpath\s*=))/s;
